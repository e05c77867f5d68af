// Small helpers. Text from the rig goes into the page as text only: nothing here takes markup.

export const byId = (id) => document.getElementById(id);

export function setText(element, text) {
    if (element.textContent !== text) element.textContent = text;
}

export function make(tag, className, text = "") {
    const element = document.createElement(tag);
    element.className = className;
    element.textContent = text;
    return element;
}

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

/** `digits` decimals and the measure, or a dash. */
export function figure(value, measure = "", digits = 0) {
    if (!isNumber(value)) return "–";
    return value.toLocaleString("en", { minimumFractionDigits: digits, maximumFractionDigits: digits }) +
        (measure && "\u00a0" + measure);
}

/** Degrees with a sign that is as wide as a digit. */
export const angle = (value) => figure(value, "", 1).replace("-", "−") + (isNumber(value) ? "°" : "");

export function bytes(value) {
    if (!isNumber(value) || value < 0) return "–";
    const measures = ["B", "kB", "MB", "GB", "TB"];
    const step = Math.min(measures.length - 1, Math.max(0, Math.floor(Math.log10(value || 1) / 3)));
    return figure(value / 1000 ** step, measures[step], step > 1 ? 1 : 0);
}

export function duration(seconds) {
    if (!isNumber(seconds) || seconds < 0) return "–";
    const hours = Math.floor(seconds / 3600);
    const minutes = Math.floor(seconds / 60) % 60;
    if (hours > 0) return `${hours}\u00a0h ${minutes}\u00a0min`;
    return minutes > 0 ? `${minutes}\u00a0min` : `${Math.floor(seconds)}\u00a0s`;
}

export const clock = (utime_ms) => new Date(utime_ms).toLocaleTimeString("en-GB");

export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** Resolves when the page can be seen: a hidden one asks the rig for nothing. */
export function visible() {
    if (!document.hidden) return Promise.resolve();
    return new Promise((done) => {
        const look = () => {
            if (document.hidden) return;
            document.removeEventListener("visibilitychange", look);
            done();
        };
        document.addEventListener("visibilitychange", look);
    });
}
