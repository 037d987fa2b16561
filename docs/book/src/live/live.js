// Shows a scene: its sliders, its numbers, its picture and the chart of its energy. The scenes are in top.js, body.js and pendulum.js.
//
// Tests read the data attributes of the element of the class `live`: status, steps, energyError and momentumError.

import { View, drawChart, scientific } from "./view.js";

/** Places of `number` in the module; docs/book/live/src/run.rs has their table. */
const TIME = 0;
const STEPS = 1;
const ENERGY = 2;
const ENERGY_CHANGE = 3;
const ENERGY_ERROR = 4;
const MOMENTUM_ERROR = 5;
const LONGEST_STEP = 6;
const CONSERVED = 7;
const CONFIGURATION = 10;

/** Why a run does not begin or go on, by the numbers of docs/book/live/src/refusal.rs. */
const REFUSALS = {
    1: () => "There is no run: reset it.",
    2: () => "A number is not finite.",
    3: () => "The step size, the length and the moments must be positive.",
    4: () => "No body has these moments: each is at most the sum of the two others.",
    5: () => "There is no method of this order.",
    6: longest => "The step is too long: its equation has no solution."
        + (longest > 0 ? ` The longest step from here is ${longest.toPrecision(3)} s.` : ""),
    7: () => "The equation of the step was not solved: take a shorter step.",
    8: () => "This start is no state of the system.",
};

/** Steps that the button makes, in as many pieces as the chart gets points. */
const JUMP = { pieces: 1000, steps: 100, label: "100 000 steps" };

/** The longest time that one frame makes up for, s. */
const LONGEST_FRAME = 0.1;

/** Time between points of the path and of the chart, s, unless steps are longer. */
const SPACING = 0.02;

/** Points of the path and of the chart. */
const MOST_POINTS = 1500;

/**
 * Shows a scene in the element of the class `live`:
 *
 * - `start(module, values)` begins a run and returns 0 or the number of a refusal;
 * - `sliders` have a name, a label, a unit, a value, and either `values` or `min`, `max` and `step`;
 * - `size` is the number of entries of the configuration;
 * - `radius(values)` is the radius of the sphere on which the tip moves, 1 where it is left out;
 * - `tip(configuration, values)` is the point that leaves a path;
 * - `draw(view, configuration, values, conserved)` draws the body.
 */
export async function show(scene) {
    const root = document.querySelector(".live");
    root.replaceChildren();
    const canvas = append(root, "canvas", { className: "scene" });
    const controls = append(root, "div");
    const sliders = scene.sliders.map(slider => addSlider(controls, slider));
    const buttons = append(controls, "div", { className: "buttons" });
    const readings = {
        time: addReading(controls, "time", "s"),
        steps: addReading(controls, "steps", ""),
        energy: addReading(controls, "energy", "J"),
        energyError: addReading(controls, "largest energy error", "J"),
        momentumError: addReading(controls, "largest momentum error", "kg·m²/s"),
    };
    const message = append(root, "p", { className: "message" });
    message.setAttribute("role", "status");
    const chart = append(root, "canvas", { className: "chart" });
    describe(canvas, "The scene, drawn as it moves. Drag it to look from another side.");
    describe(chart, "Chart of the energy against time. The largest energy error is among the numbers above it.");

    let module;
    try {
        const bytes = await fetch(new URL("clebsch_live.wasm", import.meta.url));
        if (!bytes.ok) {
            throw new Error(`status ${bytes.status}`);
        }
        module = (await WebAssembly.instantiate(await bytes.arrayBuffer())).instance.exports;
    } catch (error) {
        message.textContent = `The steppers do not load (${error.message}). docs/book/build makes them.`;
        root.dataset.status = "missing";
        return;
    }

    const view = new View(canvas);
    let isPaused = matchMedia("(prefers-reduced-motion: reduce)").matches;
    let refusal = 0;
    let values;
    let path;
    let energies;
    // time that has passed and is not stepped yet, s
    let owed = 0;

    const configuration = () => Array.from({ length: scene.size }, (_, i) => module.number(CONFIGURATION + i));
    const conserved = () => [0, 1, 2].map(i => module.number(CONSERVED + i));

    function restart() {
        values = Object.fromEntries(sliders.map(slider => [slider.name, slider.read()]));
        path = [];
        energies = [];
        owed = 0;
        refusal = scene.start(module, values);
        message.textContent = "";
        record();
    }

    function record() {
        if (refusal !== 0) {
            message.textContent = REFUSALS[refusal](module.number(LONGEST_STEP));
        }
        if (Number.isNaN(module.number(TIME))) {
            return;
        }
        path.push(scene.tip(configuration(), values));
        energies.push([module.number(TIME), module.number(ENERGY_CHANGE)]);
        path.splice(0, path.length - MOST_POINTS);
        energies.splice(0, energies.length - MOST_POINTS);
    }

    function advance(steps) {
        if (refusal === 0) {
            refusal = module.advance(steps);
            record();
        }
    }

    function jump() {
        const before = performance.now();
        for (let piece = 0; piece < JUMP.pieces; piece++) {
            advance(JUMP.steps);
        }
        const milliseconds = performance.now() - before;
        // points that are far apart are no path
        path = [];
        if (refusal === 0) {
            message.textContent = `${JUMP.label} took ${milliseconds.toFixed(0)} ms in this browser.`;
        }
    }

    const pause = append(buttons, "button", { textContent: isPaused ? "Go on" : "Pause", name: "pause" });
    pause.onclick = () => {
        isPaused = !isPaused;
        pause.textContent = isPaused ? "Go on" : "Pause";
    };
    append(buttons, "button", { textContent: "Start again", name: "restart", onclick: restart });
    append(buttons, "button", {
        textContent: "Reset",
        name: "reset",
        onclick: () => {
            sliders.forEach(slider => slider.reset());
            restart();
        },
    });
    append(buttons, "button", { textContent: JUMP.label, name: "jump", onclick: jump });
    sliders.forEach(slider => slider.input.addEventListener("input", restart));

    let last = performance.now();
    function frame(now) {
        requestAnimationFrame(frame);
        if (!isPaused) {
            owed += Math.min((now - last) / 1000, LONGEST_FRAME) / values.step_size;
            const piece = Math.max(Math.round(SPACING / values.step_size), 1);
            while (owed >= 1) {
                const steps = Math.min(Math.floor(owed), piece);
                owed -= steps;
                advance(steps);
            }
        }
        last = now;
        write();
        view.begin();
        view.globe(scene.radius?.(values) ?? 1);
        if (!Number.isNaN(module.number(TIME))) {
            view.path(path);
            scene.draw(view, configuration(), values, conserved());
        }
        drawChart(chart, energies, "energy less the energy at the start, J", "time, s");
    }

    function write() {
        readings.time(module.number(TIME).toFixed(2));
        readings.steps(module.number(STEPS).toFixed(0));
        readings.energy(module.number(ENERGY).toFixed(6).replace("-", "−"));
        readings.energyError(scientific(module.number(ENERGY_ERROR)));
        readings.momentumError(scientific(module.number(MOMENTUM_ERROR)));
        root.dataset.status = refusal !== 0 ? "refused" : isPaused ? "paused" : "running";
        root.dataset.steps = module.number(STEPS);
        root.dataset.energyError = module.number(ENERGY_ERROR);
        root.dataset.momentumError = module.number(MOMENTUM_ERROR);
    }

    restart();
    requestAnimationFrame(frame);
}

/** Appends an element with these properties. */
function append(parent, tag, properties = {}) {
    const element = Object.assign(document.createElement(tag), properties);
    parent.append(element);
    return element;
}

/** Gives a picture its text for screen readers. */
function describe(canvas, text) {
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", text);
}

/** A slider with its label; `values` make its notches, where it has them. */
function addSlider(parent, { name, label, unit, value, values, min, max, step }) {
    const row = append(parent, "label");
    append(row, "span", { textContent: label });
    const output = append(row, "output");
    const input = append(row, "input", { type: "range", name });
    input.min = values ? 0 : min;
    input.max = values ? values.length - 1 : max;
    input.step = values ? 1 : step;
    const read = () => values ? values[Number(input.value)] : Number(input.value);
    const write = () => {
        output.textContent = unit === "°" ? `${read()}°` : `${read()} ${unit}`;
        input.setAttribute("aria-valuetext", output.textContent);
    };
    const reset = () => {
        input.value = values ? values.indexOf(value) : value;
        write();
    };
    input.addEventListener("input", write);
    reset();
    return { name, input, read, reset };
}

/** A row with a number; returns the function that writes it. */
function addReading(parent, label, unit) {
    const row = append(parent, "div", { className: "reading" });
    append(row, "span", { textContent: label });
    const output = append(row, "output");
    return text => {
        output.textContent = text === "NaN" ? "–" : `${text} ${unit}`;
    };
}
