import { show } from "./live.js";
import { add, circle, column } from "./view.js";

/** Where the disc sits on the axis, and its radius; the axis has the length 1. */
const HEIGHT = 0.6;
const RADIUS = 0.38;
const SPOKES = 6;

show({
    sliders: [
        { name: "spin", label: "spin about the body axis", unit: "rad/s", min: 0, max: 10, step: 0.1, value: 6.4 },
        { name: "tilt", label: "tilt from the vertical at the start", unit: "°", min: 0, max: 170, step: 1, value: 60 },
        {
            name: "step_size",
            label: "step size",
            unit: "s",
            values: [0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32],
            value: 0.02,
        },
        { name: "order", label: "order of the method", unit: "", values: [2, 4, 6], value: 2 },
    ],
    size: 9,
    start: (module, { spin, tilt, step_size, order }) =>
        module.start_top(spin, tilt * Math.PI / 180, step_size, order),
    tip: attitude => column(attitude, 2),
    draw(view, attitude) {
        const [first, second, axis] = [0, 1, 2].map(j => column(attitude, j));
        const centre = axis.map(c => HEIGHT * c);
        const rim = circle(centre, first.map(c => RADIUS * c), second.map(c => RADIUS * c));
        const disc = () => {
            view.polygon(rim, { colour: "--first", alpha: 0.75 });
            for (let spoke = 0; spoke < SPOKES; spoke++) {
                const angle = 2 * Math.PI * spoke / SPOKES;
                const out = add(first.map(c => Math.cos(angle) * c), second, Math.sin(angle));
                view.line([centre, add(centre, out, RADIUS)], { colour: spoke === 0 ? "--second" : undefined, alpha: 0.8 });
            }
        };
        const stem = () => view.line([[0, 0, 0], centre], { width: 3 });
        const upper = () => view.line([centre, axis], { width: 3 });
        // far things first
        const isTowardsObserver = view.project(axis)[2] > 0;
        (isTowardsObserver ? [stem, disc, upper] : [upper, disc, stem]).forEach(part => part());
        view.dot(axis, 4, "--second");
        view.dot([0, 0, 0], 4);
    },
});
