// Figures of the rig and of the machine that makes the panoramas.

import { byId, bytes, duration, figure, isNumber, make, setText } from "./text.js";

const RECORDING = ["off", "armed", "on", "stopped: see events"];

export class RigFigures {
    #values = new Map();

    tell(status, health) {
        this.#tellRig(status);
        if (health) this.#tellMachine(health);
    }

    #tellRig(status) {
        if (!status) return;
        ["left", "right"].forEach((side, i) => {
            const state = status.seams[i];
            this.#set(`Seam ${side}`, `${state.replace("_", " ").toLowerCase()} · ${figure(status.seam_matches[i])} matches`,
                state === "REACQUIRE");
        });
        this.#set("Features", `tractor ${figure(status.unit_features[0])} · trailer ${figure(status.unit_features[1])}`);
        this.#set("Spread of exposures", figure(status.spread_ms, "ms", 1));
        this.#set("Dropped frame sets", figure(status.dropped), status.dropped > 0);
    }

    #tellMachine(health) {
        this.#set("JPEG", `${bytes(health.image_bytes)} of ${bytes(health.image_budget_bytes)} · quality ${health.image_quality}`);
        this.#set("Receive buffer", bytes(health.receive_buffer_bytes),
            health.receive_buffer_bytes < health.image_budget_bytes);
        this.#set("Recording", this.#recording(health), health.recording === 3 || health.recording_dropped > 0);
        this.#set("Disk free", bytes(health.disk_free_bytes));
        this.#set("Memory", bytes(health.rss_bytes));
        this.#set("Heap calls since ready", health.heap_calls < 0 ? "not counted" : figure(health.heap_calls),
            health.heap_calls > 0);
        this.#set("Major page faults", figure(health.major_faults));
        this.#set("Version", health.version || "–");
    }

    #recording(health) {
        const word = RECORDING[health.recording] ?? "–";
        const lacks = health.recording_dropped > 0 ? ` · lacks ${figure(health.recording_dropped)}` : "";
        return health.recorded_bytes > 0 ? `${word} · ${bytes(health.recorded_bytes)}${lacks}` : word;
    }

    #set(name, text, bad = false) {
        if (!this.#values.has(name)) {
            const value = make("dd", "");
            byId("no-figures").hidden = true;
            byId("figures").append(make("dt", "", name), value);
            this.#values.set(name, value);
        }
        const value = this.#values.get(name);
        setText(value, text);
        value.title = text;
        value.classList.toggle("bad", bad);
    }
}

/** What stands in the header; null for what nobody has said lately. */
export function tellHeadline(status, health) {
    setText(byId("latency"), status ? figure(status.latency_ms, "ms", 0) : "–");
    setText(byId("misses"), status ? figure(status.deadline_misses) : "–");
    setText(byId("rate"), isNumber(health?.panoramas_per_s) ? figure(health.panoramas_per_s, "/s", 1) : "–");
    setText(byId("calibration"), health ? health.calibration_id || "none" : "–");
    setText(byId("uptime"), health ? duration(health.uptime_s) : "–");
}
