// Draws points of space on a canvas, and the chart below it. Colours are those of the theme of the book.

/** Share of the canvas that a sphere of radius 1 fills. */
const FILL = 0.92;

/** A parallel projection that the pointer turns. Its depth grows towards the observer. */
export class View {
    constructor(canvas) {
        this.canvas = canvas;
        this.context = canvas.getContext("2d");
        this.azimuth = -0.6;
        this.elevation = 0.35;
        canvas.onpointerdown = event => canvas.setPointerCapture(event.pointerId);
        canvas.onpointermove = event => {
            if (event.buttons !== 0) {
                this.azimuth += event.movementX / 150;
                this.elevation = Math.min(Math.max(this.elevation + event.movementY / 150, -1.5), 1.5);
            }
        };
    }

    /** Clears the canvas and fits it to its element. */
    begin() {
        [this.width, this.height] = fit(this.canvas, this.context);
        this.scale = Math.min(this.width, this.height) / 2 * FILL;
        this.style = getComputedStyle(this.canvas);
    }

    /** A colour of the style sheet, such as `--first`, or that of the text. */
    colour(name) {
        return name ? this.style.getPropertyValue(name) : this.style.color;
    }

    /** Right, up and towards the observer, of a point of space with the third axis up. */
    project([x, y, z]) {
        const sine = Math.sin(this.azimuth);
        const cosine = Math.cos(this.azimuth);
        const right = cosine * x - sine * y;
        const away = sine * x + cosine * y;
        const up = Math.cos(this.elevation) * z + Math.sin(this.elevation) * away;
        return [right, up, Math.sin(this.elevation) * z - Math.cos(this.elevation) * away];
    }

    /** A point of space in pixels. */
    pixel(point) {
        const [right, up] = this.project(point);
        return [this.width / 2 + this.scale * right, this.height / 2 - this.scale * up];
    }

    /** A line through points. */
    line(points, { colour, width = 1.5, alpha = 1, dash = [] } = {}) {
        this.trace(points);
        Object.assign(this.context, { strokeStyle: this.colour(colour), lineWidth: width, globalAlpha: alpha });
        this.context.setLineDash(dash);
        this.context.stroke();
    }

    /** A polygon, with its edge in the colour of the text. */
    polygon(points, { colour, alpha = 1 } = {}) {
        this.trace(points);
        this.context.closePath();
        Object.assign(this.context, { fillStyle: this.colour(colour), globalAlpha: alpha });
        this.context.fill();
        Object.assign(this.context, { strokeStyle: this.colour(), lineWidth: 1, globalAlpha: 0.6 });
        this.context.setLineDash([]);
        this.context.stroke();
    }

    /** A disc of so many pixels. */
    dot(point, radius, colour) {
        const context = this.context;
        context.beginPath();
        context.arc(...this.pixel(point), radius, 0, 2 * Math.PI);
        Object.assign(context, { fillStyle: this.colour(colour), globalAlpha: 1 });
        context.fill();
    }

    /** A word at a point, or so many pixels to its right. */
    text(point, word, colour, right = 0) {
        const context = this.context;
        const [x, y] = this.pixel(point);
        Object.assign(context, { fillStyle: this.colour(colour), globalAlpha: 1, font: fontOf(this.style) });
        Object.assign(context, { textAlign: "center", textBaseline: "middle" });
        context.fillText(word, x + right, y);
    }

    /** The outline and the equator of a sphere, and the vertical. */
    globe(radius) {
        const context = this.context;
        context.beginPath();
        context.arc(this.width / 2, this.height / 2, this.scale * radius, 0, 2 * Math.PI);
        Object.assign(context, { strokeStyle: this.colour(), lineWidth: 1, globalAlpha: 0.25 });
        context.setLineDash([]);
        context.stroke();
        this.line(circle([0, 0, 0], [radius, 0, 0], [0, radius, 0]), { width: 1, alpha: 0.25 });
        this.line([[0, 0, -radius], [0, 0, radius]], { width: 1, alpha: 0.25, dash: [4, 4] });
    }

    /** A path that fades with its age, and behind the sphere. */
    path(points) {
        for (let i = 1; i < points.length; i++) {
            const isInFront = this.project(points[i])[2] >= 0;
            const alpha = (isInFront ? 1 : 0.5) * (0.2 + 0.8 * i / points.length);
            this.line([points[i - 1], points[i]], { colour: "--second", width: 2, alpha });
        }
    }

    /** Begins a path on the canvas. */
    trace(points) {
        this.context.beginPath();
        points.forEach(point => this.context.lineTo(...this.pixel(point)));
    }
}

/** Points of the circle or ellipse with this centre and these half axes. */
export function circle(centre, first, second, count = 64) {
    return Array.from({ length: count + 1 }, (_, i) => {
        const angle = 2 * Math.PI * i / count;
        return centre.map((c, k) => c + Math.cos(angle) * first[k] + Math.sin(angle) * second[k]);
    });
}

/** A column of a matrix of three rows that are stored one after the other. */
export function column(matrix, j) {
    return [matrix[j], matrix[3 + j], matrix[6 + j]];
}

/** a + s b */
export function add(a, b, s = 1) {
    return a.map((value, i) => value + s * b[i]);
}

/** Draws the points (x, y) of a curve about y = 0, with the range of both. */
export function drawChart(canvas, points, title, unit) {
    const context = canvas.getContext("2d");
    const [width, height] = fit(canvas, context);
    const style = getComputedStyle(canvas);
    const [left, right, top, bottom] = [8, width - 8, 26, height - 22];
    const largest = Math.max(...points.map(([, y]) => Math.abs(y)), 0);
    const [first, last] = points.length > 1 ? [points[0][0], points.at(-1)[0]] : [0, 1];
    const x = value => left + (right - left) * (value - first) / (last - first || 1);
    const y = value => (top + bottom) / 2 - (bottom - top) / 2 * value / (largest || 1);

    Object.assign(context, { strokeStyle: style.color, lineWidth: 1, globalAlpha: 0.25 });
    context.strokeRect(left, top, right - left, bottom - top);
    context.beginPath();
    context.moveTo(left, y(0));
    context.lineTo(right, y(0));
    context.stroke();

    Object.assign(context, { strokeStyle: style.getPropertyValue("--first"), lineWidth: 1.5, globalAlpha: 1 });
    context.beginPath();
    points.forEach(point => context.lineTo(x(point[0]), y(point[1])));
    context.stroke();

    Object.assign(context, { fillStyle: style.color, font: fontOf(style), textBaseline: "middle", textAlign: "left" });
    context.fillText(title, left, 12);
    context.fillText(first.toFixed(1), left, height - 9);
    context.textAlign = "center";
    context.fillText(unit, (left + right) / 2, height - 9);
    context.textAlign = "right";
    context.fillText(last.toFixed(1), right, height - 9);
    context.fillText(`± ${scientific(largest)}`, right, 12);
}

/** A number with two digits and a power of ten, such as 1.2·10⁻⁵. */
export function scientific(value) {
    if (!(Math.abs(value) > 0)) {
        return `${value}`;
    }
    const [digits, exponent] = value.toExponential(1).split("e");
    const raised = [...exponent.replace("+", "")].map(sign => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)]).join("");
    return `${digits}·10${raised}`;
}

/** Fits the pixels of a canvas to its element, and clears it. Returns its width and height in units of the style sheet. */
function fit(canvas, context) {
    const ratio = window.devicePixelRatio;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    return [width, height];
}

function fontOf(style) {
    return `${style.fontSize} ${style.fontFamily}`;
}
