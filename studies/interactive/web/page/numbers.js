// Numbers, the gauge of stress, both plots and the sentences.
import { plot } from "./plots.js";

const at = (id) => document.getElementById(id);
const deg = (rad) => (rad * 180) / Math.PI;
// Times and counts of the machine; what the pivot does comes as text from the server, whose formatter is the only one.
const short = (value, digits = 3) =>
  value === null || value === undefined ? "–" : Number(value.toPrecision(digits)).toString();
// A gap of states [s] from which on nothing moved meanwhile.
const STILL = 0.3;
// Parts of a design's own scales that the axes of the plots span at least.
const LEAST = 1e-3;

export class Numbers {
  constructor() {
    this.times = [];
    this.spoken = -1000;
    this.drawn = -1000;
    this.last = "";
  }

  show(state, ring) {
    this.count(state);
    const held = state.mode === "held",
      texts = state.texts;
    const rows = [
      ["rotation", texts.rotation],
      ["body's shift x, y", texts.shift],
      ...(state.centre_shift === null ? [] : [["centre shift", texts.centre_shift]]),
      ...(held
        ? [
            ["moment", texts.moment],
            ["force x", texts.force_x],
            ["force y", texts.force_y],
            ["stiffness", texts.stiffness],
          ]
        : [
            ["simulated", texts.simulated],
            ["kinetic energy", texts.kinetic],
            ["dissipated by strips and steps", texts.dissipated],
          ]),
      ["strain energy", texts.strain],
      ...(state.values.load
        ? [
            ["the load's energy", texts.potential],
            ["critical load", texts.critical],
          ]
        : []),
      ...(state.grip === null ? [] : [["grip", texts.grip]]),
      ["time scale", state.values.time_scale >= 1 ? "real time" : `1 : ${short(1 / state.values.time_scale)}`],
      ["solver", `${short(state.solve_ms, 2)} ms, ${state.iterations} iterations`],
    ];
    if (state.track_ms !== undefined)
      rows.push([
        "tracking",
        `${short(state.track_ms, 2)} ms, ${state.sight.state}` +
          (state.sight.rms !== undefined ? `, ${state.sight.rms.toFixed(3)} px` : ""),
      ]);
    at("numbers").replaceChildren(
      ...rows.flatMap(([name, value]) => {
        const term = document.createElement("dt"),
          data = document.createElement("dd");
        term.textContent = name;
        data.textContent = value;
        return [term, data];
      }),
    );
    this.gauge(state);
    this.sentences(state);
    this.plots(ring);
  }

  count(state) {
    const now = performance.now();
    this.times.push(now);
    while (now - this.times[0] > 2000) this.times.shift();
    const span = now - this.times[0];
    at("rate").textContent = span > 0 ? `${((1000 * (this.times.length - 1)) / span).toFixed(0)} Hz` : "";
    clearTimeout(this.idle);
    this.idle = setTimeout(() => {
      at("rate").textContent = "";
    }, 2000);
  }

  gauge(state) {
    const share = state.stress.of_yield,
      none = state.stress.max < 1e-6 * state.scale.stress;
    at("gauge").style.width = `${Math.min(100, 100 * (share ?? 0))}%`;
    at("gauge").classList.toggle("over", share > 1);
    const where =
      state.stress.place === 0
        ? "at the ground clamp"
        : state.stress.place === state.shape[0].length - 1
          ? "at the body's clamp"
          : "in the span";
    at("gauge-text").textContent = none
      ? "no stress"
      : `largest stress ${state.texts.stress}, ` +
        (share === null ? "yield strength is not known" : state.texts.of_yield) +
        `, strip ${state.stress.strip + 1} ${where}`;
  }

  sentences(state) {
    const list = at("faults"),
      now = state.warnings.map((w) => w.text);
    if ([...list.children].map((item) => item.textContent).join() !== now.join()) {
      list.replaceChildren(
        ...now.map((text) => {
          const item = document.createElement("li");
          item.textContent = text;
          return item;
        }),
      );
    }
    this.say(state);
  }

  // The sentence is shown at once, and spoken by screen readers at most once a second, but never a stale one.
  say(state) {
    at("status").textContent = state.status;
    clearTimeout(this.timer);
    const kind = `${state.mode} ${state.paused}`,
      wait = 1000 - (performance.now() - this.spoken);
    if (state.status === this.last) return;
    if (kind === this.kind && wait > 0) {
      this.timer = setTimeout(() => this.say(state), wait);
      return;
    }
    at("spoken").textContent = this.last = state.status;
    this.kind = kind;
    this.spoken = performance.now();
  }

  // Curves that go on by a point are drawn ten times a second; what comes sooner is not forgotten.
  plots(ring) {
    const now = performance.now(),
      early = ring.live && 95 - (now - this.drawn);
    clearTimeout(this.later);
    if (early > 0) {
      this.later = setTimeout(() => this.plots(ring), early);
      return;
    }
    this.drawn = now;
    const states = ring.states.slice(0, ring.place + 1),
      end = ring.current?.at ?? 0;
    const recent = states.filter((s) => end - s.at <= 10);
    const scale = ring.current?.scale ?? { energy: 1, moment: 1 };
    const sum = (e) => e.strain + e.kinetic + e.potential;
    const top = Math.max(LEAST * scale.energy, ...recent.map((s) => Math.abs(sum(s.energy))));
    const [unit, per] = top < 1e-4 ? ["µJ", 1e6] : top < 0.1 ? ["mJ", 1e3] : ["J", 1];
    at("energy-unit").textContent = unit;
    const line = (value) =>
      recent.flatMap((s, k) => {
        const before = recent[k - 1],
          now = [s.at - end, per * value(s.energy)];
        return before && s.at - before.at > STILL ? [[s.at - end, per * value(before.energy)], now] : [now];
      });
    plot(
      at("energy"),
      [
        { points: line(sum), colour: "--sum" },
        { points: line((e) => e.kinetic), colour: "--kinetic", dashed: true },
        { points: line((e) => e.strain), colour: "--strain" },
      ],
      { x: [-10, 0], fromZero: true, unitX: "s", least: LEAST * scale.energy * per },
    );
    this.moments(ring, states);
  }

  // The design's curve, that of the design before, where it yields, what was held of this design, and now.
  moments(ring, states) {
    const now = ring.current,
      { curve, ghost } = window.studio;
    if (!now || !curve) return;
    const held = states.filter((s) => s.mode === "held" && s.design === now.design).slice(-600);
    const last = deg(curve.rotation[curve.rotation.length - 1]),
      yields = curve.yields ? deg(curve.yields[0]) : last;
    const reach = Math.min(last, Math.max(0.3 * last, 1.25 * yields, 1.1 * Math.abs(deg(now.pose[2]))));
    const within = curve.moment.filter((_, k) => deg(curve.rotation[k]) <= 1.05 * reach);
    const most = Math.max(...within.map(Math.abs), 1.05 * Math.abs(now.force[2]), LEAST * now.scale.moment);
    const [unit, per] =
      most < 1e-3 ? ["µN m", 1e6] : most < 1 ? ["mN m", 1e3] : most < 1e3 ? ["N m", 1] : ["kN m", 1e-3];
    at("moment-unit").textContent = unit;
    const both = (c) => [
      ...c.rotation.map((r, k) => [-deg(r), -per * c.moment[k]]).reverse(),
      ...c.rotation.map((r, k) => [deg(r), per * c.moment[k]]),
    ];
    plot(
      at("moment"),
      [
        ...(ghost ? [{ points: both(ghost), colour: "--dim", dashed: true }] : []),
        { points: both(curve), colour: "--quiet" },
        { points: held.map((s) => [deg(s.pose[2]), per * s.force[2]]), colour: "--strain", dots: true },
        ...(now.mode === "held"
          ? [{ points: [[deg(now.pose[2]), per * now.force[2]]], colour: "--strain", now: true }]
          : []),
      ],
      {
        x: [-reach, reach],
        y: [-per * most, per * most],
        unitX: "°",
        limits: curve.yields ? [-yields, yields] : [],
      },
    );
    at("limits").textContent = curve.text + (ghost && ghost.text !== curve.text ? `; before: ${ghost.text}` : "");
  }
}
