// What holds the page together: one state at a time from the server, shown with the picture it belongs to.
import { Socket } from "./socket.js";
import { Camera } from "./camera.js";
import { View } from "./view.js";
import { Numbers } from "./numbers.js";
import { Ring } from "./ring.js";
import { Controls } from "./controls.js";
import { Pointer } from "./pointer.js";
import { bindKeys } from "./keys.js";
import * as files from "./files.js";

const at = (id) => document.getElementById(id);
const studio = {
  state: null,
  picture: null,
  welcome: null,
  curve: null,
  ghost: null,
  shown: 0,
  errors: [],
  trips: [],
  wrong: false,
};
window.studio = studio;

const view = new View(at("stage"));
const numbers = new Numbers();
const ring = new Ring();
Object.assign(studio, { view, ring });
const socket = new Socket(received, lost);
Object.assign(studio, { socket, send });
const camera = new Camera(socket, say);
const controls = new Controls(send, wrong);
const pointer = new Pointer(at("stage"), view, studio, send, controls, redraw);

// A change that is part of a drag leaves the ghost of the design before alone.
function send(event, part = false) {
  if (studio.wrong && event.do !== "tick") say(""); // an error is of what was sent before
  if (event.do !== "pose") pointer.forget();
  if (event.do === "preset") controls.settle();
  if (!ring.live && !["pose", "tick"].includes(event.do)) actions.live(); // no change of a state that is not shown
  if (["preset", "parameter"].includes(event.do) && !part) studio.fresh = true;
  socket.send(event);
}
function say(text, error = false) {
  at("note").textContent = text;
  studio.wrong = error;
}
function wrong(text) {
  say(text, true);
}

function received(message, picture) {
  if (message.kind === "welcome") return welcome(message);
  if (message.kind === "error") {
    studio.errors.push(message.text);
    camera.answered(message.seq);
    controls.answered(message.seq);
    return wrong(message.text);
  }
  if (message.kind === "curve") return curve(message);
  if (message.kind === "case") return files.save("pivot.toml", message.text, "application/toml");
  const bitmap = picture ?? camera.picture(message.seq);
  camera.answered(message.seq);
  studio.state = message;
  if (bitmap) {
    studio.picture?.close?.();
    studio.picture = bitmap;
  }
  if (message.seq !== null && message.seq === pointer.seq)
    studio.trips = [...studio.trips.slice(-199), performance.now() - message.seq];
  controls.answered(message.seq);
  keep();
  ring.add(message);
  studio.shown += 1;
  if (ring.live) show(message, studio.picture);
  if (bitmap) ring.film(bitmap);
}

function show(state, picture) {
  view.draw(state, picture, ring.centres);
  numbers.show(state, ring);
  controls.follow(state);
  at("mode").textContent = state.mode + (state.paused ? ", paused" : "");
  at("pace").textContent = /\((.*)\)/.exec(state.warnings.find((w) => w.code === "slowed")?.text)?.[1] ?? "";
  at("mode").classList.toggle("released", state.mode === "released");
  at("release").firstChild.textContent = state.mode === "released" ? "Catch " : "Release ";
  at("pause").firstChild.textContent = state.paused ? "Resume " : "Pause ";
  at("pause").disabled = state.mode !== "released" && !state.paused;
  at("scrub").max = ring.length - 1;
  at("scrub").value = ring.place;
  at("when").textContent = ring.live ? "live" : `${ring.age.toFixed(1)} s ago`;
  at("live").disabled = ring.live;
  studio.drawn = { seq: state.seq, t: state.t };
}

// The curve of the design before stays as a ghost: that of before a whole drag.
function curve(message) {
  const same = studio.curve && JSON.stringify(studio.curve.moment) === JSON.stringify(message.moment);
  if (studio.curve && !same && studio.fresh) studio.ghost = studio.curve;
  studio.fresh = false;
  studio.curve = message;
  if (ring.live && studio.state) show(studio.state, studio.picture);
}

let soon = 0;
function keep() {
  soon ||= setTimeout(() => {
    soon = 0;
    files.keep(studio.state);
  }, 300);
}

function welcome(message) {
  studio.welcome = message;
  if (studio.wrong) say("");
  controls.build(message);
  studio.source = { browser: "camera", film: "film", none: "no camera", server: "camera of the server" }[
    message.camera
  ];
  studio.shared = message.shared ? ", open to the network" : "";
  at("source").textContent = studio.source + studio.shared;
  at("camera-box").hidden = message.camera === "none";
  at("camera-row").hidden = message.camera !== "browser";
  if (message.camera === "browser") camera.start(noCamera);
  if (message.camera === "none") noCamera("");
  const known = files.kept(); // of a page that is loaded again, or of a server that was away
  if (!known) return;
  send({ do: "preset", name: known.preset, values: known.values, ...(known.case ? { case: known.case } : {}) });
  send({ do: "drive", by: known.drive });
  if (message.camera === "none") send({ do: "pose", pose: known.pose });
}

// Without pictures the page's own hand drives, by the rotation alone: a pull would stretch the strips at once.
function noCamera(why) {
  at("source").textContent = "no camera" + studio.shared;
  at("stage").classList.add("grab");
  pointer.on = true;
  at("hand-box").hidden = false;
  send({ do: "drive", by: "rotation" });
  if (why) say(`${why} Drag the body, or use the arrow keys.`);
}

function lost(text) {
  at("source").textContent = "not connected";
  wrong(text);
}

const actions = {
  release: () => send({ do: studio.state?.mode === "released" ? "catch" : "release" }),
  pause: () => send({ do: studio.state?.paused ? "resume" : "pause" }),
  reset: () => send({ do: "reset" }),
  rest: () => send({ do: "rest" }),
  csv: () => files.save("pivot.csv", files.csv(ring.states), "text/csv"),
  png: () => {
    captioned(true);
    at("stage").toBlob((blob) => files.save("pivot.png", blob, "image/png"));
    captioned(false);
  },
  shape: () => {
    at("shape").checked = !at("shape").checked;
    shape();
  },
  save: () => send({ do: "save" }),
  open: () => at("case").click(),
  live: () => {
    ring.goLive();
    if (studio.state) show(studio.state, studio.picture);
  },
  help: () => at("shortcuts").showModal(),
  back: () => scrub(ring.place - 5),
  forth: () => scrub(ring.place + 5),
  drive: () => {
    const all = studio.welcome.drives;
    send({ do: "drive", by: all[(all.indexOf(studio.state.drive) + 1) % all.length] });
  },
  turn: (angle) => pointer.nudge([0, 0, angle]),
  move: (x, y) =>
    studio.state?.drive === "rotation"
      ? say("Only the rotation is prescribed: press M to prescribe the shift, too.")
      : pointer.nudge([x, y, 0].map((way) => 1e-3 * way * studio.state.placing.length)),
  zoom: (factor) => {
    view.zoom(factor);
    redraw();
  },
  home: () => {
    view.home();
    redraw();
  },
};

function redraw() {
  if (studio.state) view.draw(studio.state, ring.live ? studio.picture : null, ring.centres);
}

// What leaves the page has its words with it.
function captioned(on) {
  view.caption = on;
  if (ring.live && studio.state) view.draw(studio.state, studio.picture, ring.centres);
}

function shape() {
  view.shaping = at("shape").checked;
  say(view.shaping ? "Drag a clamp: length, inclination and crossing follow." : "");
  if (studio.state) show(studio.state, studio.picture);
}

async function scrub(place) {
  ring.go(place);
  const state = ring.current,
    kept = ring.small;
  if (!state) return;
  if (ring.live || !kept) return show(state, ring.live ? studio.picture : null);
  const picture = Object.assign(await createImageBitmap(kept.blob), { size: kept.size });
  if (ring.current === state && !ring.live) show(state, picture);
  picture.close();
}

for (const id of ["release", "pause", "reset", "rest", "csv", "png", "save", "open", "live", "help", "home"]) {
  at(id).addEventListener("click", actions[id]);
}
at("scrub").addEventListener("input", () => scrub(Number(at("scrub").value)));
at("shape").addEventListener("change", shape);
at("mirror").addEventListener("change", () => at("stage").classList.toggle("mirrored", at("mirror").checked));
at("side").addEventListener(
  "change",
  () => at("side").checkValidity() && send({ do: "size", side_mm: Number(at("side").value) }),
);
at("camera").addEventListener("change", () => camera.start(noCamera, at("camera").value));
at("case").addEventListener("change", async () => {
  const file = at("case").files[0];
  if (file) await files.upload(file, send);
  at("case").value = "";
});
bindKeys(actions, at("keys"), at("shortcuts"));
window.addEventListener("error", (event) => studio.errors.push(String(event.message)));
window.addEventListener("unhandledrejection", (event) => studio.errors.push(String(event.reason)));
socket.open();
