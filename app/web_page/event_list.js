// What happened, newest first.

import { byId, clock, make, setText } from "./text.js";

const MOST = 200;
const CODES = {
    1: ["Camera lost", "bad"],
    2: ["Camera back", "good"],
    20: ["Seam locked", "good"],
    21: ["Seam coasts", ""],
    22: ["Seam searches", ""],
    23: ["No overlap", ""],
    40: ["Calibration mismatch", "bad"],
    60: ["Deadline missed", "bad"],
    61: ["In time again", "good"],
    62: ["Panoramas dropped", "bad"],
    63: ["Receive buffer small", "bad"],
    80: ["Recording started", "good"],
    81: ["Recording stopped", ""],
    82: ["Recording failed", "bad"],
    83: ["Recording lacks messages", "bad"],
};

export class EventList {
    #list = byId("events");
    #count = 0;

    constructor() {
        this.clear();
    }

    append(events) {
        if (events.length === 0) return;
        if (this.#count === 0) this.#list.replaceChildren();
        for (const event of events) this.#list.prepend(entry(event));
        this.#count += events.length;
        while (this.#list.children.length > MOST) this.#list.lastElementChild.remove();
        setText(byId("event-facts"), `${this.#list.children.length} shown`);
    }

    clear() {
        this.#count = 0;
        this.#list.replaceChildren(make("li", "empty", "Nothing has happened since this server was started."));
        setText(byId("event-facts"), "");
    }
}

function entry(event) {
    const [label, kind] = CODES[event.code] ?? [`Event ${event.code}`, ""];
    const item = make("li", kind);
    const time = make("time", "", clock(event.utime_ms));
    time.dateTime = new Date(event.utime_ms).toISOString();
    const what = make("span", "what");
    what.append(make("span", "label", event.subject ? `${label}: ${event.subject}` : label), make("br", ""), event.text);
    item.append(time, what);
    return item;
}
