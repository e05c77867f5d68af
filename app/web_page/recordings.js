// Logs that may be loaded down.

import { byId, bytes, make, setText, sleep, visible } from "./text.js";

const PAUSE_MS = 10000;

export class Recordings {
    #shown = "";

    async run() {
        for (;;) {
            await visible();
            try {
                const answer = await fetch("recordings", { cache: "no-store" });
                if (answer.ok) this.#show(await answer.text());
            } catch {
                // The pill at the top says that there is no connection.
            }
            await sleep(PAUSE_MS);
        }
    }

    #show(text) {
        if (text === this.#shown) return;
        this.#shown = text;
        const { folder, files } = JSON.parse(text);
        const list = byId("recordings");
        list.replaceChildren(...files.map(entry));
        if (files.length === 0) {
            list.append(make("li", "empty", folder ? "The folder holds no recording yet." :
                "No folder was named: start the server with --recordings DIR."));
        }
        const sum = files.reduce((total, file) => total + file.bytes, 0);
        setText(byId("recording-facts"), files.length > 0 ? `${files.length} files · ${bytes(sum)}` : "");
    }
}

function entry(file) {
    const item = make("li", "");
    const what = make("span", "what");
    what.append(make("span", "code", file.name), make("br", ""),
        `${bytes(file.bytes)} · ${new Date(file.modified_ms).toLocaleString("en-GB")}`);
    const link = make("a", "", "Download");
    link.href = `recordings/${encodeURIComponent(file.name)}`;
    link.download = file.name;
    link.setAttribute("aria-label", `Download ${file.name}`);
    item.append(what, link);
    return item;
}
