// Seams and meshes above the picture. They are asked for only while somebody wants to see them.

import { byId, isNumber, sleep, visible } from "./text.js";

const STALE_AFTER_MS = 1000;
const COLOURS = { tractor: "#4fe3ff", trailer: "#ffc14d", seam: "#ff3df2" };

export class OverlayView {
    #canvas = byId("overlay");
    #overlay = null;
    #serial = 0;
    #come_at_ms = -Infinity;
    #running = false;

    constructor() {
        for (const id of ["show-seams", "show-mesh"]) {
            byId(id).addEventListener("click", (event) => this.#toggle(event.currentTarget));
        }
        new ResizeObserver(() => this.#draw()).observe(byId("panorama"));
    }

    #wants(what) {
        return byId(`show-${what}`).getAttribute("aria-pressed") === "true";
    }

    #toggle(button) {
        button.setAttribute("aria-pressed", String(button.getAttribute("aria-pressed") !== "true"));
        this.#draw();
        if (!this.#running) this.#run();
    }

    async #run() {
        this.#running = true;
        while (this.#wants("seams") || this.#wants("mesh")) {
            await visible();
            try {
                await this.#take();
            } catch {
                await sleep(500);
            }
            this.#draw();
        }
        this.#running = false;
    }

    async #take() {
        const answer = await fetch(`overlay?after=${this.#serial}`,
            { cache: "no-store", signal: AbortSignal.timeout(5000) });
        if (answer.status !== 200) return;
        this.#overlay = await answer.json();
        this.#serial = Number(answer.headers.get("X-Serial"));
        this.#come_at_ms = performance.now();
    }

    #draw() {
        const picture = byId("panorama");
        const scale = window.devicePixelRatio || 1;
        this.#canvas.width = Math.round(picture.clientWidth * scale);
        this.#canvas.height = Math.round(picture.clientHeight * scale);
        const fresh = performance.now() - this.#come_at_ms <= STALE_AFTER_MS;
        if (!this.#overlay || !fresh) return;
        const context = this.#canvas.getContext("2d");
        context.scale(this.#canvas.width / this.#overlay.width, this.#canvas.height / this.#overlay.height);
        const pixel = this.#overlay.width / Math.max(1, picture.clientWidth);
        if (this.#wants("mesh")) this.#drawMeshes(context, pixel);
        if (this.#wants("seams")) this.#drawSeams(context, pixel);
    }

    #drawMeshes(context, pixel) {
        const { mesh_rows: rows, mesh_columns: columns } = this.#overlay;
        context.lineWidth = pixel;
        context.globalAlpha = 0.75;
        ["tractor", "trailer"].forEach((unit, index) => {
            const first = index * rows * columns;
            context.strokeStyle = COLOURS[unit];
            context.beginPath();
            for (let row = 0; row < rows; ++row) this.#line(context, first + row * columns, 1, columns);
            for (let column = 0; column < columns; ++column) this.#line(context, first + column, columns, rows);
            context.stroke();
        });
        context.globalAlpha = 1;
    }

    /** A line through mesh vertices; it is broken where there is none, and where a ring closes. */
    #line(context, first, step, count) {
        const { mesh_x: x, mesh_y: y, width } = this.#overlay;
        let before = null;
        for (let i = 0, at = first; i < count; ++i, at += step) {
            if (!isNumber(x[at]) || !isNumber(y[at])) {
                before = null;
            } else if (before === null || Math.abs(x[at] - x[before]) > width / 4) {
                context.moveTo(x[at], y[at]);
                before = at;
            } else {
                context.lineTo(x[at], y[at]);
                before = at;
            }
        }
    }

    #drawSeams(context, pixel) {
        const { seam_y: y, left_seam_x: left, right_seam_x: right, width } = this.#overlay;
        context.strokeStyle = COLOURS.seam;
        context.lineWidth = 3 * pixel;
        for (const x of [left, right]) {
            context.beginPath();
            y.forEach((row, i) => {
                if (!isNumber(x[i])) return;
                const continues = i > 0 && isNumber(x[i - 1]) && Math.abs(x[i] - x[i - 1]) < width / 4;
                if (continues) context.lineTo(x[i], row);
                else context.moveTo(x[i], row);
            });
            context.stroke();
        }
    }
}
