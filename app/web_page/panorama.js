// The live picture. Each request asks for the newest panorama behind the one that is shown, so a
// slow line shows fewer pictures, never older ones.

import { byId, bytes, figure, setText, sleep, visible } from "./text.js";

const STALE_AFTER_MS = 500;
const REQUEST_ENDS_AFTER_MS = 5000;

export class PanoramaView {
    #canvas = byId("panorama");
    #context = this.#canvas.getContext("2d", { alpha: false });
    #serial = 0;
    #sequence = null;
    #size_bytes = 0;
    #taken_at_ms = -Infinity;

    constructor() {
        setInterval(() => this.#refresh(), 100);
        byId("full-screen").addEventListener("click", () => this.#toggleFullScreen());
    }

    get live() {
        return performance.now() - this.#taken_at_ms <= STALE_AFTER_MS;
    }

    async run() {
        for (;;) {
            await visible();
            try {
                await this.#take();
            } catch {
                await sleep(300);
            }
        }
    }

    async #take() {
        const answer = await fetch(`panorama.jpg?after=${this.#serial}`,
            { cache: "no-store", signal: AbortSignal.timeout(REQUEST_ENDS_AFTER_MS) });
        if (answer.status === 204) return;
        if (!answer.ok) throw new Error(answer.statusText);
        const age_ms = Number(answer.headers.get("X-Age-Ms"));
        const come_at_ms = performance.now();
        const blob = await answer.blob();
        this.#serial = Number(answer.headers.get("X-Serial"));
        this.#show(await createImageBitmap(blob));
        this.#sequence = Number(answer.headers.get("X-Sequence"));
        this.#size_bytes = blob.size;
        this.#taken_at_ms = come_at_ms - age_ms;
        this.#refresh();
    }

    #show(bitmap) {
        if (this.#canvas.width !== bitmap.width || this.#canvas.height !== bitmap.height) {
            this.#canvas.width = bitmap.width;
            this.#canvas.height = bitmap.height;
        }
        this.#context.drawImage(bitmap, 0, 0);
        bitmap.close();
    }

    #refresh() {
        const live = this.live;
        byId("no-image").hidden = live;
        if (!live) {
            this.#context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
            setText(byId("picture-facts"), "");
            return;
        }
        const age_ms = performance.now() - this.#taken_at_ms;
        setText(byId("picture-facts"),
            `no. ${figure(this.#sequence)} · under ${figure(Math.ceil((age_ms + 1) / 50) * 50, "ms")} old · ` +
            `${this.#canvas.width}×${this.#canvas.height} · ${bytes(this.#size_bytes)}`);
    }

    #toggleFullScreen() {
        if (document.fullscreenElement) document.exitFullscreen();
        else byId("picture").requestFullscreen();
    }
}
