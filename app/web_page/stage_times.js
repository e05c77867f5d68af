// A bar for each stage of the work on a panorama: half of the panoramas, 99 of 100, the longest.

import { niceStep, prepare } from "./charts.js";
import { figure, isNumber } from "./text.js";

const LABEL_PX = 92;
const MOST_BAR_PX = 22;

export class StageTimes {
    #canvas;

    constructor(canvas) {
        this.#canvas = canvas;
    }

    draw(stages) {
        const { context, area, colour } = prepare(this.#canvas);
        const left = LABEL_PX;
        const right = area.x + area.width - 64;
        const shown = stages.filter((stage) => isNumber(stage.p99_ms));
        if (shown.length === 0) {
            this.#drawEmpty(context, area, colour);
            return;
        }
        const longest = Math.max(1, ...shown.map((stage) => stage.p99_ms));
        const step = niceStep(longest, 4);
        const end = Math.ceil(longest / step) * step;
        const toX = (ms) => left + (right - left) * Math.min(1, ms / end);
        this.#drawGrid(context, area, colour, toX, step, end);
        const row = area.height / shown.length;
        shown.forEach((stage, i) => {
            this.#drawStage(context, colour, stage, area.y + row * (i + 0.5), Math.min(MOST_BAR_PX, row * 0.7), toX, right);
        });
    }

    #drawGrid(context, area, colour, toX, step, end) {
        context.strokeStyle = colour("grid");
        context.fillStyle = colour("quiet");
        context.textAlign = "center";
        context.textBaseline = "top";
        for (let ms = 0; ms <= end + step / 2; ms += step) {
            const x = Math.round(toX(ms)) + 0.5;
            context.beginPath();
            context.moveTo(x, area.y);
            context.lineTo(x, area.y + area.height);
            context.stroke();
            context.fillText(`${ms.toFixed(step < 1 ? 1 : 0)} ms`, x, area.y + area.height + 8);
        }
    }

    #drawStage(context, colour, stage, middle, thickness, toX, right) {
        const bar = (to_ms, name) => {
            context.fillStyle = colour(name);
            context.fillRect(toX(0), middle - thickness / 2, Math.max(1, toX(to_ms) - toX(0)), thickness);
        };
        bar(stage.p99_ms, "soft");
        bar(stage.p50_ms, "first");
        context.fillStyle = colour("ink");
        context.textBaseline = "middle";
        context.textAlign = "right";
        context.fillText(shortened(stage.name), LABEL_PX - 8, middle);
        context.textAlign = "left";
        context.fillStyle = colour("quiet");
        context.fillText(`${figure(stage.p50_ms, "", 1)} / ${figure(stage.p99_ms, "", 1)}`, right + 8, middle);
    }

    #drawEmpty(context, area, colour) {
        context.fillStyle = colour("quiet");
        context.textAlign = "center";
        context.textBaseline = "middle";
        context.fillText("stage times come with the health message", area.x + area.width / 2, area.y + area.height / 2);
    }
}

const shortened = (name) => (name.length > 13 ? name.slice(0, 12) + "…" : name);
