import { show } from "./live.js";

/** The longest rod, m. It is drawn with the length 1. */
const LONGEST = 2;

show({
    sliders: [
        { name: "amplitude", label: "angle from the lowest point", unit: "°", min: 0, max: 179, step: 1, value: 60 },
        { name: "push", label: "push to the side", unit: "m/s", min: 0, max: 5, step: 0.1, value: 0.5 },
        { name: "length", label: "length of the rod", unit: "m", min: 0.25, max: LONGEST, step: 0.25, value: 2 },
        {
            name: "step_size",
            label: "step size",
            unit: "s",
            values: [0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32],
            value: 0.02,
        },
    ],
    size: 3,
    start: (module, { amplitude, push, length, step_size }) =>
        module.start_pendulum(amplitude * Math.PI / 180, push, length, step_size),
    radius: ({ length }) => length / LONGEST,
    tip: (bob, { length }) => bob.map(c => c * length / LONGEST),
    draw(view, bob, { length }) {
        const end = bob.map(c => c * length / LONGEST);
        view.line([[0, 0, 0], end], { width: 2.5 });
        view.dot([0, 0, 0], 3);
        view.dot(end, 10, "--first");
    },
});
