// Lines over the last minute, drawn by hand. Colours are those of the page's style.

import { isNumber } from "./text.js";

const SECONDS = 60;
const GAP_MS = 1500;
const EDGE = { left: 52, right: 12, top: 10, bottom: 26 };

/** A canvas of the size that it has on the screen, cleared; `area` is where the data goes. */
export function prepare(canvas) {
    const style = getComputedStyle(document.documentElement);
    const scale = window.devicePixelRatio || 1;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const context = canvas.getContext("2d");
    context.scale(scale, scale);
    context.font = "12px system-ui, sans-serif";
    const area = { x: EDGE.left, y: EDGE.top, width: width - EDGE.left - EDGE.right, height: height - EDGE.top - EDGE.bottom };
    return { context, area, colour: (name) => style.getPropertyValue(`--${name}`).trim() };
}

/** 1, 2 or 5 times a power of ten: about `count` steps over the span. */
export function niceStep(span, count) {
    const rough = span / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    return [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
}

export class LineChart {
    #canvas;
    #options;
    #samples = [];

    /** options: lines (names of colours), least (smallest span of the axis), symmetric, measure. */
    constructor(canvas, options) {
        this.#canvas = canvas;
        this.#options = options;
    }

    /** A sample is [time in ms, value of each line ...]; null where there is none. */
    append(samples) {
        this.#samples.push(...samples);
    }

    /** Forgets what was drawn: the server counts its time anew. */
    clear() {
        this.#samples = [];
    }

    draw(now_ms) {
        const oldest_ms = now_ms - SECONDS * 1000;
        const kept = this.#samples.findIndex(([at_ms]) => at_ms >= oldest_ms);
        this.#samples.splice(0, kept < 0 ? this.#samples.length : kept);
        const { context, area, colour } = prepare(this.#canvas);
        const axis = this.#axis();
        const toY = (value) => area.y + area.height * (1 - (value - axis.low) / (axis.high - axis.low));
        const toX = (at_ms) => area.x + area.width * (1 - (now_ms - at_ms) / (SECONDS * 1000));
        this.#drawAxis(context, area, colour, axis, toY);
        if (this.#samples.length === 0) {
            this.#drawEmpty(context, area, colour);
            return;
        }
        this.#options.lines.forEach((line, i) => {
            context.strokeStyle = colour(line);
            context.lineWidth = i === 0 ? 3 : 1.5;  // where both lie on each other, both are seen
            context.lineJoin = "round";
            this.#drawLine(context, i + 1, toX, toY);
        });
    }

    #axis() {
        let [low, high] = this.#options.symmetric ? [-this.#options.least, this.#options.least] : [0, this.#options.least];
        for (const [, ...values] of this.#samples) {
            for (const value of values) {
                if (!isNumber(value)) continue;
                low = Math.min(low, this.#options.symmetric ? -Math.abs(value) : value);
                high = Math.max(high, this.#options.symmetric ? Math.abs(value) : value);
            }
        }
        const step = niceStep(high - low, 4);
        return { low: Math.floor(low / step) * step, high: Math.ceil(high / step) * step, step };
    }

    #drawAxis(context, area, colour, axis, toY) {
        context.strokeStyle = colour("grid");
        context.fillStyle = colour("quiet");
        context.lineWidth = 1;
        context.textAlign = "right";
        context.textBaseline = "middle";
        const digits = axis.step < 1 ? 1 : 0;
        for (let value = axis.low; value <= axis.high + axis.step / 2; value += axis.step) {
            const y = Math.round(toY(value)) + 0.5;
            context.beginPath();
            context.moveTo(area.x, y);
            context.lineTo(area.x + area.width, y);
            context.stroke();
            const label = value.toFixed(digits).replace(/^-0$/, "0").replace("-", "−");
            context.fillText(label + this.#options.measure, area.x - 6, y);
        }
        context.textBaseline = "top";
        for (const seconds of [60, 45, 30, 15, 0]) {
            const x = area.x + area.width * (1 - seconds / SECONDS);
            context.textAlign = seconds === 0 ? "right" : seconds === 60 ? "left" : "center";
            context.fillText(seconds === 0 ? "now" : `−${seconds} s`, x, area.y + area.height + 8);
        }
    }

    #drawEmpty(context, area, colour) {
        context.fillStyle = colour("quiet");
        context.textAlign = "center";
        context.textBaseline = "middle";
        context.fillText("nothing in the last minute", area.x + area.width / 2, area.y + area.height / 2 - 12);
    }

    #drawLine(context, index, toX, toY) {
        let before_ms = -Infinity;
        context.beginPath();
        for (const sample of this.#samples) {
            const value = sample[index];
            if (!isNumber(value)) {
                if (value === null) before_ms = -Infinity;
                continue;
            }
            const continues = sample[0] - before_ms <= GAP_MS;
            context[continues ? "lineTo" : "moveTo"](toX(sample[0]), toY(value));
            before_ms = sample[0];
        }
        context.stroke();
    }
}
