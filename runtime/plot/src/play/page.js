"use strict";
// Plays the motion of this page. Vectors are in units of the picture: 1 is the radius of all that is drawn.
const motion = JSON.parse(document.getElementById("motion").textContent);
const UNITS = 10000;
const TICKS = 1e6;
const COLOURS = {
    light: [[31, 92, 168], [214, 106, 22], [45, 134, 72], [190, 44, 52], [118, 78, 160], [0, 128, 138]],
    dark: [[98, 158, 232], [240, 150, 72], [104, 190, 130], [236, 110, 112], [176, 140, 222], [80, 190, 198]],
};
const REST = { azimuth: -0.65, elevation: 0.35, zoom: 1 };
const find = name => document.querySelector(`[name=${name}]`);
const canvas = document.querySelector("canvas");
const context = canvas.getContext("2d");
const darkness = matchMedia("(prefers-color-scheme: dark)");
const view = { ...REST };
/** A share of the duration, and whether it grows. */
const now = { share: 0, isPlaying: !matchMedia("(prefers-reduced-motion: reduce)").matches };

// ── the data ──

/** The numbers of a channel: the first one and the changes; one that stays is there once. */
function unpack(changes, unit) {
    let sum = 0;
    return Float64Array.from({ length: motion.count }, (_, i) => (sum += changes[i] ?? 0) / unit);
}
const shares = motion.times
    ? unpack(motion.times, TICKS)
    : Float64Array.from({ length: motion.count }, (_, i) => i / Math.max(motion.count - 1, 1));
const parts = motion.parts.map((part, index) => ({ ...part, index, channels: part.data.map(changes => unpack(changes, UNITS)) }));
const globe = motion.sphere?.map(number => number / UNITS);
const duration = Math.abs(motion.end - motion.start);

/** The last frame at or before a share of the duration. */
function frameAt(share) {
    let low = 0;
    let high = motion.count - 1;
    while (low < high) {
        const middle = Math.ceil((low + high) / 2);
        if (shares[middle] <= share + 1e-9) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return low;
}

/** The vectors of a part between two frames. Where it moves far from one to the next, they are those of the nearer frame. */
function vectorsAt(part, frame, fraction) {
    const next = Math.min(frame + 1, motion.count - 1);
    const isNear = part.channels.every(numbers => Math.abs(numbers[next] - numbers[frame]) < 0.15);
    const share = isNear ? fraction : Math.round(fraction);
    const numbers = part.channels.map(channel => channel[frame] + share * (channel[next] - channel[frame]));
    return Array.from({ length: numbers.length / 3 }, (_, k) => numbers.slice(3 * k, 3 * k + 3));
}

// ── vectors and the projection ──

const sum = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const scaled = (a, s) => a.map(x => s * x);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = a => Math.hypot(...a);
const mean = points => scaled(points.reduce((a, b) => sum(a, b)), 1 / points.length);
const combined = (centre, axes, shares) => axes.reduce((point, axis, k) => sum(point, axis, shares[k]), centre);

let eye;
/** Right, up and towards the observer, with the third axis up; pixels of the canvas. */
function look() {
    const pixels = devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = canvas;
    canvas.width = Math.round(width * pixels);
    canvas.height = Math.round(height * pixels);
    context.setTransform(pixels, 0, 0, pixels, 0, 0);
    const [sa, ca] = [Math.sin(view.azimuth), Math.cos(view.azimuth)];
    const [se, ce] = [Math.sin(view.elevation), Math.cos(view.elevation)];
    eye = {
        right: [ca, sa, 0],
        up: [se * -sa, se * ca, ce],
        towards: [ce * sa, -ce * ca, se],
        scale: Math.min(width, height) / 2 * 0.88 * view.zoom,
        middle: [width / 2, height / 2],
        width,
        height,
    };
}
const pixel = point => [eye.middle[0] + eye.scale * dot(eye.right, point), eye.middle[1] - eye.scale * dot(eye.up, point)];
const depth = point => dot(eye.towards, point);

// ── drawing ──

const colour = ([r, g, b], alpha = 1) => `rgba(${r | 0},${g | 0},${b | 0},${alpha})`;
const style = name => getComputedStyle(document.documentElement).getPropertyValue(name);
const palette = () => COLOURS[darkness.matches ? "dark" : "light"];
/** All that is drawn, with its depth: what is far comes first. */
let strokes = [];
const add = (at, draw) => strokes.push({ at, draw });

function trace(points) {
    context.beginPath();
    for (const point of points) {
        context.lineTo(...pixel(point));
    }
}

function line(points, tint, width, alpha = 1) {
    add(depth(mean(points)), () => {
        trace(points);
        Object.assign(context, { strokeStyle: colour(tint, alpha), lineWidth: width, lineJoin: "round" });
        // where pieces of a pale line overlap they would be darker
        context.lineCap = alpha < 1 ? "butt" : "round";
        context.stroke();
    });
}

/** A disc of so many pixels, in front of lines at the same place. */
function disc(point, tint, radius) {
    add(depth(point) + 0.01, () => {
        context.beginPath();
        context.arc(...pixel(point), radius, 0, 2 * Math.PI);
        context.fillStyle = colour(tint);
        context.fill();
    });
}

function arrow(foot, vector, tint, width) {
    const tip = sum(foot, vector);
    line([foot, tip], tint, width);
    add(depth(tip), () => {
        const [a, b] = [pixel(foot), pixel(tip)];
        const size = Math.hypot(b[0] - a[0], b[1] - a[1]);
        const head = Math.min(11, size / 2);
        const [x, y] = [(b[0] - a[0]) / (size || 1), (b[1] - a[1]) / (size || 1)];
        context.beginPath();
        context.moveTo(b[0], b[1]);
        context.lineTo(b[0] - head * (x + 0.42 * y), b[1] - head * (y - 0.42 * x));
        context.lineTo(b[0] - head * (x - 0.42 * y), b[1] - head * (y + 0.42 * x));
        context.fillStyle = colour(tint);
        context.fill();
    });
}

/** A face of a convex body about a centre, lit from the upper left. Faces that look away are hidden. */
function face(points, centre, tint, edge) {
    const middle = mean(points);
    let normal = cross(sum(points[1], points[0], -1), sum(points.at(-1), points[0], -1));
    const outside = sum(middle, centre, -1);
    normal = scaled(normal, (dot(normal, outside) < 0 ? -1 : 1) / (length(normal) || 1));
    const facing = dot(normal, eye.towards);
    if (facing <= 0) {
        return;
    }
    const light = 0.62 + 0.2 * facing + 0.25 * (0.7 * dot(normal, eye.up) - 0.5 * dot(normal, eye.right));
    const shaded = tint.map(x => Math.min(255, x * Math.max(light, 0.48)));
    add(depth(middle), () => {
        trace(points);
        context.closePath();
        context.fillStyle = colour(shaded);
        context.fill();
        // the colour of the face hides the seam to its neighbour
        Object.assign(context, { strokeStyle: edge ?? colour(shaded), lineWidth: edge ? 1 : 0.8, lineJoin: "round" });
        context.stroke();
    });
    return { middle, normal };
}

const mixed = (a, b, share) => a.map((x, i) => x + (b[i] - x) * share);
const WHITE = [255, 255, 255];

/** The tints of the faces across the three axes. */
const AXES = [0, 0.16, 0.34];

function cuboid([centre, ...axes], tint) {
    const edge = darkness.matches ? "rgba(0,0,0,0.45)" : "rgba(255,255,255,0.65)";
    for (let k = 0; k < 3; k++) {
        for (const side of [-1, 1]) {
            const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
                const shares = [0, 0, 0];
                [shares[k], shares[(k + 1) % 3], shares[(k + 2) % 3]] = [side, a, b];
                return combined(centre, axes, shares);
            });
            const seen = face(corners, centre, mixed(tint, WHITE, AXES[k]), edge);
            // a ring marks the end of the third axis
            if (seen && k === 2 && side === 1) {
                const half = Math.min(length(axes[0]), length(axes[1])) * 0.3;
                const [u, v] = [axes[0], axes[1]].map(axis => scaled(axis, half / (length(axis) || 1)));
                const ring = Array.from({ length: 25 }, (_, i) => i * Math.PI / 12)
                    .map(angle => sum(sum(seen.middle, u, Math.cos(angle)), v, Math.sin(angle)));
                const at = depth(seen.middle) + 1e-6;
                add(at, () => {
                    trace(ring);
                    Object.assign(context, { strokeStyle: colour(WHITE, 0.85), lineWidth: 2 });
                    context.stroke();
                });
            }
        }
    }
}

/** Octants in two tints show how it turns. */
function ellipsoid([centre, ...axes], tint) {
    const [ROWS, COLUMNS] = [16, 32];
    const point = (row, column) => {
        const [latitude, longitude] = [(row / ROWS - 0.5) * Math.PI, 2 * Math.PI * column / COLUMNS];
        const [c, s] = [Math.cos(latitude), Math.sin(latitude)];
        return combined(centre, axes, [c * Math.cos(longitude), c * Math.sin(longitude), s]);
    };
    for (let row = 0; row < ROWS; row++) {
        for (let column = 0; column < COLUMNS; column++) {
            const corners = [point(row, column), point(row, column + 1), point(row + 1, column + 1), point(row + 1, column)];
            // at a pole two corners are one
            const points = row === 0 ? corners.slice(1) : row === ROWS - 1 ? corners.slice(0, 3) : corners;
            const octant = (row < ROWS / 2) + Math.floor(4 * column / COLUMNS);
            face(points, centre, mixed(tint, WHITE, octant % 2 === 0 ? 0.05 : 0.32));
        }
    }
}

/** The path of a point up to now: paler long ago, and behind the sphere. */
function path(part, frame, place, tint) {
    // long pieces would be in front of a body or behind it as one
    const [PIECES, LONGEST] = [160, 40];
    const [x, y, z] = part.channels;
    const points = Array.from({ length: frame + 1 }, (_, i) => [x[i], y[i], z[i]]);
    points.push(place);
    const size = Math.min(Math.ceil(points.length / PIECES), LONGEST);
    for (let start = 0; start < points.length - 1; start += size) {
        const piece = points.slice(start, start + size + 1);
        const age = 1 - (start + size) / points.length;
        const behind = globe && depth(sum(mean(piece), globe.slice(0, 3), -1)) < 0;
        line(piece, tint, 1.8, (behind ? 0.5 : 1) * (0.5 + 0.5 * Math.max(0, 1 - 3 * age)));
    }
}

function sphere() {
    const [centre, radius] = [globe.slice(0, 3), globe[3]];
    const soft = darkness.matches ? [154, 164, 178] : [92, 100, 114];
    add(-10, () => {
        context.beginPath();
        context.arc(...pixel(centre), radius * eye.scale, 0, 2 * Math.PI);
        Object.assign(context, { strokeStyle: colour(soft, 0.6), lineWidth: 1.2, fillStyle: colour(soft, 0.05) });
        context.fill();
        context.stroke();
    });
    const at = (latitude, longitude) => combined(centre, [[radius, 0, 0], [0, radius, 0], [0, 0, radius]],
        [Math.cos(latitude) * Math.cos(longitude), Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)]);
    const circle = (count, point) => {
        const points = Array.from({ length: count + 1 }, (_, i) => point(i / count));
        for (let i = 0; i < count; i += 3) {
            const piece = points.slice(i, i + 4);
            const behind = depth(sum(mean(piece), centre, -1)) < 0;
            line(piece, soft, 0.8, behind ? 0.12 : 0.32);
        }
    };
    for (let i = -2; i <= 2; i++) {
        circle(48, share => at(i * Math.PI / 6, 2 * Math.PI * share));
    }
    for (let i = 0; i < 12; i++) {
        circle(30, share => at((share - 0.5) * Math.PI, i * Math.PI / 6));
    }
}

/** The axes of space, in a corner. */
function corner() {
    const [x, y, size] = [44, eye.height - 44, 28];
    const soft = style("--soft");
    Object.assign(context, { strokeStyle: soft, fillStyle: soft, lineWidth: 1.4 });
    Object.assign(context, { font: "12px system-ui, Helvetica, sans-serif", textAlign: "center", textBaseline: "middle" });
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, k) => {
        const [right, up] = [dot(eye.right, axis), dot(eye.up, axis)];
        context.beginPath();
        context.moveTo(x, y);
        context.lineTo(x + size * right, y - size * up);
        context.stroke();
        context.fillText(`e${k + 1}`, x + (size + 11) * right, y - (size + 11) * up);
    });
}

function drawPart(part, frame, fraction) {
    const tint = palette()[part.index % palette().length];
    const vectors = vectorsAt(part, frame, fraction);
    const [place, ...others] = vectors;
    switch (part.kind) {
        case "cuboid":
            return cuboid(vectors, tint);
        case "ellipsoid":
            return ellipsoid(vectors, tint);
        case "point":
            path(part, frame, place, tint);
            return disc(place, tint, 5);
        case "link":
            line([place, others[0]], tint, 4);
            return vectors.forEach(end => disc(end, tint, 4));
        case "arrow":
            return arrow(place, others[0], tint, 2.6);
        default:
            return others.forEach((axis, k) => arrow(place, axis, palette()[[3, 2, 0][k]], 2.4));
    }
}

function draw() {
    look();
    strokes = [];
    if (globe) {
        sphere();
    }
    const frame = frameAt(now.share);
    const pace = (shares[frame + 1] ?? 1) - shares[frame];
    const fraction = pace > 0 ? Math.min(Math.max((now.share - shares[frame]) / pace, 0), 1) : 0;
    parts.forEach(part => drawPart(part, frame, fraction));
    strokes.sort((a, b) => a.at - b.at);
    context.clearRect(0, 0, eye.width, eye.height);
    strokes.forEach(stroke => stroke.draw());
    corner();
    report(frame);
}

/** Shows the time, and says for tests and readers of the page what was drawn. */
function report(frame) {
    const time = motion.start + now.share * (motion.end - motion.start);
    const digits = Math.min(Math.max(3 - Math.floor(Math.log10(duration || 1)), 0), 9);
    find("now").textContent = `${time.toFixed(digits)} ${motion.unit}`;
    find("time").value = now.share;
    find("time").setAttribute("aria-valuetext", find("now").textContent);
    find("play").textContent = now.isPlaying ? "Pause" : "Play";
    const data = { status: now.isPlaying ? "playing" : "paused", time, frame, strokes: strokes.length, parts: parts.length };
    Object.assign(document.documentElement.dataset, data, { azimuth: view.azimuth, elevation: view.elevation, zoom: view.zoom });
}

// ── the controls ──

let isStale = true;
const refresh = () => isStale = true;

/** Seconds that the motion takes at speed 1: its own, unless that is too short or too long to watch. */
const seconds = duration >= 4 && duration <= 60 ? duration : 15;
const perSecond = speed => Number((duration / seconds * speed).toPrecision(2));
for (const speed of [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8]) {
    const text = duration > 0 ? `${perSecond(speed)} ${motion.unit || "units"} a second` : `${speed}`;
    find("speed").append(new Option(text, speed, speed === 1, speed === 1));
}

function play(isPlaying) {
    now.isPlaying = isPlaying && motion.count > 1;
    refresh();
}

function seek(share) {
    now.share = Math.min(Math.max(share, 0), 1);
    refresh();
}

function turn(azimuth, elevation) {
    view.azimuth -= azimuth;
    view.elevation = Math.min(Math.max(view.elevation + elevation, -Math.PI / 2), Math.PI / 2);
    refresh();
}

function zoom(factor) {
    view.zoom = Math.min(Math.max(view.zoom * factor, 0.2), 20);
    refresh();
}

find("play").onclick = () => play(!now.isPlaying);
find("time").oninput = event => {
    play(false);
    seek(Number(event.target.value));
};
find("view").onclick = () => {
    Object.assign(view, REST);
    refresh();
};
canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
canvas.onpointermove = event => {
    if (event.buttons !== 0) {
        turn(event.movementX / 150, event.movementY / 150);
    }
};
canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY / 600));
}, { passive: false });
canvas.onkeydown = event => {
    const keys = {
        ArrowLeft: () => turn(-0.1, 0),
        ArrowRight: () => turn(0.1, 0),
        ArrowUp: () => turn(0, -0.1),
        ArrowDown: () => turn(0, 0.1),
        "+": () => zoom(1.15),
        "-": () => zoom(1 / 1.15),
        " ": () => play(!now.isPlaying),
    };
    if (keys[event.key]) {
        event.preventDefault();
        keys[event.key]();
    }
};
new ResizeObserver(refresh).observe(canvas);
darkness.addEventListener("change", () => {
    showNames();
    refresh();
});

/** Names in their colours. A frame has a colour for each axis. */
function showNames() {
    document.querySelector(".names").replaceChildren(...parts.filter(part => part.name).map(part => {
        const [item, box] = [document.createElement("li"), document.createElement("i")];
        const tint = palette()[part.index % palette().length];
        const stripes = [3, 2, 0].map((k, i) => `${colour(palette()[k])} ${33 * i}% ${33 * i + 34}%`);
        box.style.background = part.kind === "frame" ? `linear-gradient(90deg, ${stripes})` : colour(tint);
        item.append(box, part.name);
        return item;
    }));
}

/** `#t=2.5` opens at that time, in a pause. */
function openAt() {
    const time = parseFloat(new URLSearchParams(location.hash.slice(1)).get("t"));
    if (Number.isFinite(time)) {
        play(false);
        seek(duration > 0 ? (time - motion.start) / (motion.end - motion.start) : 0);
    }
}
addEventListener("hashchange", openAt);

let last;
function tick(moment) {
    if (now.isPlaying && last !== undefined) {
        // a page that was hidden goes on where it was
        const passed = Math.min((moment - last) / 1000, 0.1);
        const share = now.share + passed / seconds * Number(find("speed").value);
        seek(share < 1 ? share : now.share < 1 ? 1 : 0);
    }
    last = moment;
    if (isStale) {
        isStale = false;
        draw();
    }
    requestAnimationFrame(tick);
}

showNames();
play(now.isPlaying);
openAt();
requestAnimationFrame(tick);
