// Presets, sliders with typed values in their units, and the hand's three sliders.
const at = (id) => document.getElementById(id);
const HAND = [
  { name: "rotation", unit: "°", low: -100, high: 100, step: 0.5, place: 2, per: 180 / Math.PI },
  { name: "shift x", unit: "mm", low: -60, high: 60, step: 0.01, place: 0, per: 1e3 },
  { name: "shift y", unit: "mm", low: -60, high: 60, step: 0.01, place: 1, per: 1e3 },
];

export class Controls {
  constructor(send, say) { Object.assign(this, { send, say, rows: new Map(), hand: [], seen: "", count: 0, flying: null, next: null, drag: null }); }

  build(welcome) {
    this.welcome = welcome;
    at("preset").replaceChildren(...Object.entries(welcome.presets).map(([name, p]) => new Option(p.title, name)));
    at("solver").replaceChildren(...Object.entries(welcome.solvers).map(([name, title]) => new Option(title, name)));
    at("preset").onchange = () => this.send({ do: "preset", name: at("preset").value });
    at("drive").onchange = () => this.send({ do: "drive", by: at("drive").value });
    at("solver").onchange = () => this.send({ do: "solver", name: at("solver").value });
    at("sweeps").onchange = () => at("sweeps").checkValidity() && at("sweeps").value && this.send({ do: "solver", name: at("solver").value, sweeps: Number(at("sweeps").value) });
    this.flying = this.next = this.drag = null;
    at("material").replaceChildren(new Option("of one's own", ""), ...Object.keys(welcome.materials).map((name) => new Option(name, name)));
    at("material").onchange = () => at("material").value && this.send({ do: "preset", name: this.state.preset, values: { ...this.state.values, ...welcome.materials[at("material").value] } });
    at("side").value = (welcome.side * 1e3).toFixed(1);
    at("sliders").replaceChildren(...welcome.parameters.map((p) => this.row(p)));
    this.hand = [];
    at("hand-sliders").replaceChildren(...HAND.map((h) => this.handRow(h)));
  }

  row(p) {
    const on = (si) => (p.least ? Math.asinh(si / p.least) : p.logarithmic ? Math.log(Math.max(si, p.low)) : si);
    const back = (v) => (p.least ? p.least * Math.sinh(v) : p.logarithmic ? Math.exp(v) : v);
    const { line, range, number } = pair(p.label, p.unit);
    Object.assign(range, { min: on(p.low), max: on(p.high), step: (on(p.high) - on(p.low)) / 400 });
    Object.assign(number, { min: p.low * p.per_si, max: p.high * p.per_si, step: "any" });
    const slid = (end) => {
      const v = Number(range.value), nought = p.least && Math.abs(v) < range.step / 2, si = nought ? 0 : this.within(p.name, back(v));
      number.value = tidy(si * p.per_si);
      this.change({ do: "parameter", name: p.name, value: si }, p.name, end);
    };
    range.oninput = () => slid(false);
    range.onchange = () => slid(true);
    number.onchange = () => {
      if (number.checkValidity() && number.value !== "") return this.change({ do: "parameter", name: p.name, value: Number(number.value) / p.per_si }, p.name, true);
      this.say(`${p.label}: from ${tidy(p.low * p.per_si)} to ${tidy(p.high * p.per_si)} ${p.unit}.`);
      if (this.state) number.value = tidy(this.state.values[p.name] * p.per_si);
    };
    this.rows.set(p.name, { range, number, set: (si) => { range.value = on(si); number.value = tidy(si * p.per_si); } });
    return line;
  }

  // A value between the ends of its slider.
  within(name, value) {
    const { low, high } = this.welcome.parameters.find((p) => p.name === name);
    return Math.min(high, Math.max(low, value));
  }

  // The newest event goes up as soon as the one before is answered; those of one drag, by its key, are undone together.
  change(event, key, end) {
    this.next = { event, key, end };
    this.flush();
  }

  // A drag without an event of its own at its end is over, after the one that waits.
  ended() { if (this.next) this.next.end = true; else this.drag = null; }

  flush() {
    if (this.flying !== null || !this.next) return;
    const { event, key, end } = this.next, part = this.drag === key;
    this.next = null;
    this.drag = end ? null : key;
    this.send({ ...event, part, seq: (this.flying = -++this.count) });
  }

  // What waits goes up at once: what comes behind it, an undo say, is of after it.
  settle() { this.flying = null; this.flush(); }

  answered(seq) {
    if (seq !== this.flying) return;
    this.flying = null;
    this.flush();
  }

  handRow(h) {
    const { line, range, number } = pair(h.name, h.unit);
    for (const input of [range, number]) Object.assign(input, { min: h.low, max: h.high, step: h.step });
    number.step = "any";
    const change = (value) => {
      const pose = [...(window.studio.state?.wanted ?? [0, 0, 0])];
      pose[h.place] = value / h.per;
      this.send({ do: "pose", pose });
    };
    range.oninput = () => change(Number(range.value));
    number.onchange = () => {
      if (number.checkValidity() && number.value !== "") change(Number(number.value));
      else { this.say(`${h.name}: from ${h.low} to ${h.high} ${h.unit}.`); number.value = ""; number.blur(); }
    };
    this.hand.push({ h, range, number });
    return line;
  }

  // Show the server's values, but leave alone what the user is typing or dragging.
  follow(state) {
    this.state = state;
    for (const { h, range, number } of this.hand) {
      const value = (state.grip !== null ? state.wanted : state.displacement)[h.place] * h.per;
      if (document.activeElement !== range) range.value = value;
      if (document.activeElement !== number) number.value = (Math.round(100 * value) / 100 + 0).toFixed(2);
      range.disabled = number.disabled = h.place < 2 ? state.drive === "rotation" : state.drive === "pull";
    }
    at("drive").value = state.drive;
    at("solver").value = state.solver;
    at("sweeps-row").hidden = state.solver !== "printed";
    if (document.activeElement !== at("sweeps")) at("sweeps").value = state.sweeps;
    if (this.flying !== null || this.next) return;
    const seen = JSON.stringify([state.preset, state.values]);
    if (seen === this.seen) return;
    this.seen = seen;
    if (![...at("preset").options].some((option) => option.value === state.preset)) at("preset").append(new Option("a design of one's own", state.preset));
    at("preset").value = state.preset;
    at("material").value = Object.entries(this.welcome?.materials ?? {}).find(([, m]) => Object.entries(m).every(([name, value]) => state.values[name] === value))?.[0] ?? "";
    at("preset-note").textContent = this.welcome?.presets[state.preset]?.note ?? "";
    for (const [name, row] of this.rows) row.set(state.values[name]);
  }
}

const tidy = (value) => Number(value.toPrecision(5)).toString();

function pair(label, unit) {
  const line = document.createElement("div"), name = document.createElement("span"), range = document.createElement("input");
  const number = document.createElement("input"), mark = document.createElement("span");
  line.className = "slider";
  name.textContent = label;
  range.type = "range"; number.type = "number";
  range.setAttribute("aria-label", `${label}, slider`);
  number.setAttribute("aria-label", `${label} in ${unit}`);
  mark.className = "unit"; mark.textContent = unit;
  line.append(name, range, number, mark);
  return { line, range, number };
}
