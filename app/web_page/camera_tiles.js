// One tile for each camera: its thumbnail while it lives, and what is said of it.

import { byId, figure, isNumber, make, setText, sleep, visible } from "./text.js";

const STALE_AFTER_MS = 3000;
const PAUSE_MS = 400;
const WORDS = { live: "LIVE", lost: "LOST", unknown: "NO CONTACT" };

/** LIVE, LIVE: DIRTY, LOST, or why its pictures are not shown. */
function wordFor({ state, condition }) {
    const word = WORDS[state] ?? state;
    if (state === "unknown" || !condition || condition === "good" || condition === "lost") return word;
    return state === "live" ? `${word}: ${condition.toUpperCase()}` : condition.toUpperCase();
}

class Tile {
    constructor() {
        this.root = make("li", "camera");
        this.canvas = make("canvas", "");
        this.canvas.width = 192;
        this.canvas.height = 108;
        this.instead = make("p", "instead");
        const thumbnail = make("div", "thumbnail");
        thumbnail.append(this.canvas, this.instead);
        this.name = make("p", "name");
        this.word = make("span", "word");
        this.rate = make("span", "");
        this.unit = make("span", "");
        this.counts = make("span", "");
        const about = make("div", "about");
        const first = make("p", "line");
        first.append(this.word, this.rate);
        const second = make("p", "line");
        second.append(this.unit, this.counts);
        about.append(this.name, first, second);
        this.root.append(thumbnail, about);
        this.pictured_at_ms = -Infinity;
    }

    tell(camera) {
        this.key = camera.name.toUpperCase();
        this.state = camera.state;
        this.root.dataset.state = camera.state;
        setText(this.name, camera.name);
        this.name.title = camera.name;
        setText(this.word, wordFor(camera));
        setText(this.unit, camera.unit);
        const told = camera.state !== "unknown" && isNumber(camera.frames_per_s);
        setText(this.rate, told ? figure(camera.frames_per_s, "fps", 1) : "");
        const damaged = (camera.lost ?? 0) + (camera.corrupted ?? 0);
        setText(this.counts, isNumber(camera.delivered) ? `${figure(damaged)} lost` : "");
        this.refresh();
    }

    show(bitmap, age_ms) {
        this.canvas.width = bitmap.width;
        this.canvas.height = bitmap.height;
        this.canvas.getContext("2d").drawImage(bitmap, 0, 0);
        this.pictured_at_ms = performance.now() - age_ms;
        this.refresh();
    }

    /** What stands still is covered: an old picture must not look like a live one. */
    refresh() {
        const fresh = performance.now() - this.pictured_at_ms <= STALE_AFTER_MS;
        this.instead.hidden = fresh && this.state === "live";
        setText(this.instead, this.state === "live" ? "NO PREVIEW" : this.state === "lost" ? "NO DATA" : "");
    }
}

export class CameraTiles {
    #tiles = [];
    #cameras = [];
    #serial = 0;

    tell(cameras) {
        this.#cameras = cameras;
        while (this.#tiles.length < cameras.length) {
            const tile = new Tile();
            this.#tiles.push(tile);
            byId("cameras").append(tile.root);
        }
        for (const tile of this.#tiles.splice(cameras.length)) tile.root.remove();
        cameras.forEach((camera, i) => this.#tiles[i].tell(camera));
        byId("no-cameras").hidden = cameras.length > 0;
        const lost = cameras.filter((camera) => camera.state === "lost").map((camera) => camera.name);
        const count = `${cameras.length} ${cameras.length === 1 ? "camera" : "cameras"}`;
        setText(byId("camera-facts"), lost.length > 0 ? `${lost.length} of ${count} lost: ${lost.join(", ")}` :
            cameras.length > 0 ? count : "");
    }

    /** Nobody says anything of them any more. */
    silence() {
        this.tell(this.#cameras.map((camera) => ({ ...camera, state: "unknown" })));
    }

    get lost() {
        return this.#cameras.filter((camera) => camera.state === "lost").length;
    }

    async run() {
        for (;;) {
            await visible();
            try {
                await this.#take();
            } catch {
                await sleep(1000);
            }
            await sleep(PAUSE_MS);
        }
    }

    async #take() {
        const answer = await fetch(`previews?after=${this.#serial}`,
            { cache: "no-store", signal: AbortSignal.timeout(5000) });
        if (answer.status !== 200) return;
        const pictures = unpack(await answer.arrayBuffer());
        this.#serial = Number(answer.headers.get("X-Serial"));
        for (const { name, age_ms, jpeg } of pictures) {
            const tile = this.#tiles.find((candidate) => candidate.key === name);
            if (tile) await createImageBitmap(jpeg).then((bitmap) => tile.show(bitmap, age_ms), () => {});
        }
    }
}

/** Thumbnails one behind the other: length of the name, name, age in ms, length, JPEG. */
function unpack(buffer) {
    const view = new DataView(buffer);
    const pictures = [];
    for (let at = 0; at < buffer.byteLength;) {
        const letters = view.getUint8(at);
        const name = new TextDecoder().decode(new Uint8Array(buffer, at + 1, letters));
        at += 1 + letters;
        const size = view.getUint32(at + 4);
        const jpeg = new Blob([new Uint8Array(buffer, at + 8, size)], { type: "image/jpeg" });
        pictures.push({ name, age_ms: view.getUint32(at), jpeg });
        at += 8 + size;
    }
    return pictures;
}
