// Joins the parts: one stream tells the state, each part shows its share of it.

import { CameraTiles } from "./camera_tiles.js";
import { LineChart } from "./charts.js";
import { EventList } from "./event_list.js";
import { OverlayView } from "./overlay.js";
import { PanoramaView } from "./panorama.js";
import { Recordings } from "./recordings.js";
import { RigFigures, tellHeadline } from "./rig_figures.js";
import { StageTimes } from "./stage_times.js";
import { angle, byId, figure, make, setText } from "./text.js";

const SILENT_AFTER_MS = 1500;
const RETRY_MS = 1000;
const STATUS_HOLDS_MS = 1000;
const HEALTH_HOLDS_MS = 2500;

const panorama = new PanoramaView();
const cameras = new CameraTiles();
const events = new EventList();
const figures = new RigFigures();
const stages = new StageTimes(byId("stages-chart"));
const latency = new LineChart(byId("latency-chart"), { lines: ["first", "second"], least: 40, measure: " ms" });
const hitch = new LineChart(byId("hitch-chart"), { lines: ["first", "second"], least: 5, symmetric: true, measure: "°" });
new OverlayView();

let health = null;
let stream = null;
let heard_at_ms = -Infinity;
let status_age_ms = null;

const isRecent = (age_ms, holds_ms) => age_ms !== null && age_ms <= holds_ms;

/** Fills a legend and returns the elements that take the values of its lines. */
function legend(id, lines) {
    return lines.map(([colour, name]) => {
        const value = make("b", "");
        byId(id).append(make("i", colour), `${name} `, value);
        return value;
    });
}

const latency_values = legend("latency-legend", [["first", "capture to LCM"], ["second", "computing"]]);
const hitch_values = legend("hitch-legend", [["first", "CAN sensor"], ["second", "images"]]);
legend("stages-legend", [["first", "half of the panoramas"], ["soft", "99 of 100"]]);

function tellCharts(news) {
    latency.append(news.traces.status.map(([at, capture_to_lcm, computing]) => [at, capture_to_lcm, computing]));
    latency.draw(news.now_ms);
    hitch.append(joined(news.traces));
    hitch.draw(news.now_ms);
    setText(latency_values[0], figure(news.status?.latency_ms, "ms", 1));
    setText(latency_values[1], figure(news.status?.total_ms, "ms", 1));
    setText(hitch_values[0], news.hitch_angle?.angle_deg == null ? news.hitch_angle?.quality ?? "–" :
        angle(news.hitch_angle.angle_deg));
    setText(hitch_values[1], angle(news.status?.articulation_deg));
}

/** Angles of sensor and images in one row by time; undefined where the other one speaks. */
function joined(traces) {
    const sensor = traces.hitch_angle.map(([at, angle]) => [at, angle, undefined]);
    const images = traces.status.map(([at, , , angle]) => [at, undefined, angle]);
    return [...sensor, ...images].sort((a, b) => a[0] - b[0]);
}

function tell(news) {
    heard_at_ms = performance.now();
    status_age_ms = news.status_age_ms;
    health = news.health ?? health;
    cameras.tell(news.cameras);
    events.append(news.events);
    tellHeadline(isRecent(news.status_age_ms, STATUS_HOLDS_MS) ? news.status : null,
        isRecent(news.health_age_ms, HEALTH_HOLDS_MS) ? health : null);
    figures.tell(news.status, health);
    tellCharts(news);
    if (news.health) stages.draw(news.health.stages);
    byId("warning").hidden = !health?.warning;
    setText(byId("warning"), health?.warning ?? "");
}

function connect() {
    let first = true;
    stream = new EventSource("events");
    stream.onmessage = (message) => {
        if (first) {
            latency.clear();
            hitch.clear();
            events.clear();
            first = false;
        }
        tell(JSON.parse(message.data));
    };
    stream.onerror = () => {
        disconnect();
        setTimeout(connect, RETRY_MS);
    };
}

function disconnect() {
    stream?.close();
    stream = null;
}

/** The word in the header, what kind it is of, and why there is no picture. */
function stateNow() {
    if (performance.now() - heard_at_ms > SILENT_AFTER_MS) {
        return ["NO CONNECTION", "bad", "The server of this page does not answer."];
    }
    if (panorama.live && cameras.lost > 0) return [`LIVE, ${cameras.lost} LOST`, "warn", ""];
    if (panorama.live) return ["LIVE", "good", ""];
    return ["NO IMAGE", "bad", isRecent(status_age_ms, STATUS_HOLDS_MS) ?
        "Status comes, pictures do not: see the receive buffer below." :
        "The program that makes the panoramas is silent."];
}

function refreshState() {
    const [word, kind, why] = stateNow();
    if (word === "NO CONNECTION") {
        cameras.silence();
        tellHeadline(null, null);
    }
    setText(byId("state"), word);
    byId("state").dataset.state = kind;
    setText(byId("no-image-why"), why);
}

stages.draw([]);
latency.draw(0);
hitch.draw(0);
connect();
setInterval(refreshState, 100);
panorama.run();
cameras.run();
new Recordings().run();
