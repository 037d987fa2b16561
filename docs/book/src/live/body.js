import { show } from "./live.js";
import { add, column } from "./view.js";

const COLOURS = ["--first", "--second", "--third"];

/** The first axis of space is drawn to the right, the second one upwards: the body turns about it at the start. */
const drawn = ([x, y, z]) => [x, -z, y];

/** Half edges of the box with these moments, from a² = 6(J₂ + J₃ − J₁)/m and so on; the longest diagonal has the length 1.8. */
function halfEdges({ first, second, third }) {
    const sum = first + second + third;
    const edges = [first, second, third].map(moment => Math.sqrt(Math.max(sum - 2 * moment, 0)));
    return edges.map(edge => 0.9 * edge / Math.hypot(...edges));
}

show({
    sliders: [
        ["first", "first", 1],
        ["second", "second", 2],
        ["third", "third", 2.8],
    ].map(([name, axis, value]) => ({
        name,
        label: `moment of inertia about the ${axis} axis`,
        unit: "kg·m²",
        min: 0.5,
        max: 4,
        step: 0.1,
        value,
    })).concat([
        {
            name: "step_size",
            label: "step size",
            unit: "s",
            values: [0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64],
            value: 0.02,
        },
    ]),
    size: 9,
    start: (module, { first, second, third, step_size }) => module.start_body(first, second, third, step_size),
    tip: attitude => drawn(column(attitude, 1)),
    draw(view, attitude, values, conserved) {
        const axes = [0, 1, 2].map(j => drawn(column(attitude, j)));
        const half = halfEdges(values);
        const corner = signs => signs.reduce((point, sign, j) => add(point, axes[j], sign * half[j]), [0, 0, 0]);
        const isInFront = axis => view.project(axis)[2] > 0;
        const label = (axis, j) => {
            view.line([axis.map(c => c * half[j]), axis.map(c => c * (half[j] + 0.16))], { colour: COLOURS[j], width: 2.5 });
            view.text(axis.map(c => c * (half[j] + 0.24)), `${j + 1}`, COLOURS[j]);
        };
        axes.forEach((axis, j) => isInFront(axis) || label(axis, j));
        // a box is convex: the faces that look at the observer hide the others
        for (const j of [0, 1, 2]) {
            const side = isInFront(axes[j]) ? 1 : -1;
            const [k, l] = [(j + 1) % 3, (j + 2) % 3];
            const face = [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([a, b]) => {
                const signs = [];
                signs[j] = side;
                signs[k] = a;
                signs[l] = b;
                return corner(signs);
            });
            view.polygon(face, { colour: COLOURS[j] });
        }
        axes.forEach((axis, j) => isInFront(axis) && label(axis, j));

        const size = Math.hypot(...conserved);
        const momentum = drawn(conserved.map(c => c / size));
        view.line([momentum.map(c => 0.8 * c), momentum], { width: 3 });
        view.text(momentum, "M", undefined, 14);
    },
});
