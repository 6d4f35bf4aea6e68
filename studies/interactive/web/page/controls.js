// Presets, sliders with typed values in their units, and the hand's three sliders.
const at = (id) => document.getElementById(id);
// Shifts by the sliders, over the length of the strips; loads by theirs, over EI / L^2, and the least of them.
const SHIFT = 0.7,
  LOADS = 200,
  LEAST = 0.01;
const HAND = [
  { name: "rotation", unit: "°", low: -100, high: 100, step: 0.5, place: 2, per: 180 / Math.PI },
  { name: "shift x", unit: "mm", step: 0.01, place: 0, per: 1e3 },
  { name: "shift y", unit: "mm", step: 0.01, place: 1, per: 1e3 },
];

export class Controls {
  constructor(send, say) {
    Object.assign(this, {
      send,
      say,
      rows: new Map(),
      hand: [],
      seen: "",
      count: 0,
      flying: null,
      next: null,
      drag: null,
    });
  }

  build(welcome) {
    this.welcome = welcome;
    at("preset").replaceChildren(...Object.entries(welcome.presets).map(([name, p]) => new Option(p.title, name)));
    at("preset").onchange = () => this.send({ do: "preset", name: at("preset").value });
    at("drive").onchange = () => this.send({ do: "drive", by: at("drive").value });
    Object.assign(this, { seen: "", flying: null, next: null, drag: null });
    at("material").replaceChildren(
      new Option("other", ""),
      ...Object.keys(welcome.materials).map((name) => new Option(name, name)),
    );
    at("material").onchange = () =>
      at("material").value &&
      this.send({
        do: "preset",
        name: this.state.preset,
        values: this.of(welcome.materials[at("material").value]),
      });
    at("side").value = (welcome.side * 1e3).toFixed(1);
    at("sliders").replaceChildren(...welcome.parameters.map((p) => this.row(p)));
    this.hand = [];
    at("hand-sliders").replaceChildren(...HAND.map((h) => this.handRow(h)));
  }

  // Of some values those that this design has.
  of(values) {
    return Object.fromEntries(Object.entries(values).filter(([name]) => name in this.state.values));
  }

  row(p) {
    const row = { ...pair(p.label, p.unit), least: 1 },
      { line, range, number } = row;
    const on = (si) => (p.scale === "load" ? Math.asinh(si / row.least) : p.scale === "log" ? Math.log(si) : si);
    const back = (v) => (p.scale === "load" ? row.least * Math.sinh(v) : p.scale === "log" ? Math.exp(v) : v);
    const ends = (low, high) => {
      Object.assign(row, { low, high });
      Object.assign(range, { min: on(low), max: on(high), step: (on(high) - on(low)) / 400 });
    };
    Object.assign(number, { min: p.low * p.per_si, max: p.high * p.per_si, step: "any" });
    const slid = (end) => {
      const v = Number(range.value),
        nought = p.scale === "load" && Math.abs(v) < range.step / 2;
      const si = nought ? 0 : this.within(p.name, back(v));
      number.value = tidy(si * p.per_si);
      this.change({ do: "parameter", name: p.name, value: si }, p.name, end);
    };
    range.oninput = () => slid(false);
    range.onchange = () => slid(true);
    number.onchange = () => {
      if (number.checkValidity() && number.value !== "")
        return this.change({ do: "parameter", name: p.name, value: Number(number.value) / p.per_si }, p.name, true);
      this.say(`${p.label}: from ${tidy(p.low * p.per_si)} to ${tidy(p.high * p.per_si)} ${p.unit}.`);
      if (this.state) row.set(this.state.values[p.name]);
    };
    // A slider reaches as far as the design is large.
    row.fit = (si, state, renewed) => {
      if (!renewed && si >= row.low && si <= row.high) return;
      if (p.scale === "linear") return ends(p.low, p.high);
      if (p.scale === "log")
        return ends(Math.max(p.low, si / this.welcome.span), Math.min(p.high, si * this.welcome.span));
      row.least = LEAST * state.scale.force;
      const most = Math.max(LOADS * state.scale.force, 2 * Math.abs(si));
      ends(-most, most);
    };
    row.set = (si) => {
      line.hidden = si === undefined;
      range.disabled = si === null;
      if (si !== null && si !== undefined) range.value = on(si);
      number.value = si === null || si === undefined ? "" : tidy(si * p.per_si);
    };
    this.rows.set(p.name, row);
    return line;
  }

  // A value between the ends of its slider.
  within(name, value) {
    const { low, high } = this.welcome.parameters.find((p) => p.name === name);
    return Math.min(high, Math.max(low, value));
  }

  // The newest event goes up as soon as the one before is answered; those of one drag have its key.
  change(event, key, end) {
    this.next = { event, key, end };
    this.flush();
  }

  // A drag without an event of its own at its end is over, after the one that waits.
  ended() {
    if (this.next) this.next.end = true;
    else this.drag = null;
  }

  flush() {
    if (this.flying !== null || !this.next) return;
    const { event, key, end } = this.next,
      part = this.drag === key;
    this.next = null;
    this.drag = end ? null : key;
    this.send({ ...event, seq: (this.flying = -++this.count) }, part);
  }

  // What waits goes up at once: what comes behind it is of after it.
  settle() {
    this.flying = null;
    this.flush();
  }

  answered(seq) {
    if (seq !== this.flying) return;
    this.flying = null;
    this.flush();
  }

  handRow(h) {
    const { line, range, number } = pair(h.name, h.unit);
    const limit = (low, high) => {
      for (const input of [range, number]) Object.assign(input, { min: low, max: high, step: h.step });
      number.step = "any";
    };
    if (h.low) limit(h.low, h.high);
    const change = (value) => {
      const pose = [...(window.studio.state?.wanted ?? [0, 0, 0])];
      pose[h.place] = value / h.per;
      this.send({ do: "pose", pose });
    };
    range.oninput = () => change(Number(range.value));
    number.onchange = () => {
      if (number.checkValidity() && number.value !== "") change(Number(number.value));
      else {
        this.say(`${h.name}: from ${number.min} to ${number.max} ${h.unit}.`);
        number.value = "";
        number.blur();
      }
    };
    this.hand.push({ h, range, number, limit });
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
    if (this.flying !== null || this.next) return;
    const seen = JSON.stringify([state.preset, state.values]),
      renewed = state.preset !== this.preset;
    if (seen === this.seen) return;
    Object.assign(this, { seen, preset: state.preset });
    for (const { h, limit } of this.hand)
      if (!h.low) limit(...[-1, 1].map((side) => tidy(side * SHIFT * h.per * state.placing.length, 3)));
    if (![...at("preset").options].some((option) => option.value === state.preset))
      at("preset").append(new Option("own design", state.preset));
    at("preset").value = state.preset;
    at("material").value =
      Object.entries(this.welcome?.materials ?? {}).find(([, m]) =>
        Object.entries(this.of(m)).every(([name, value]) => state.values[name] === value),
      )?.[0] ?? "";
    const known = this.welcome?.presets[state.preset] ?? {},
      same = Object.entries(known.values ?? {}).every(([name, value]) => state.values[name] === value);
    at("preset-note").textContent = same ? (known.note ?? "") : "";
    for (const [name, row] of this.rows) {
      const value = state.values[name];
      if (typeof value === "number") row.fit(value, state, renewed);
      row.set(value);
    }
  }
}

const tidy = (value, digits = 5) => Number(value.toPrecision(digits)).toString();

function pair(label, unit) {
  const line = document.createElement("div"),
    name = document.createElement("span"),
    range = document.createElement("input");
  const number = document.createElement("input"),
    mark = document.createElement("span");
  line.className = "slider";
  name.textContent = label;
  range.type = "range";
  number.type = "number";
  number.addEventListener("beforeinput", (event) => {
    if (event.data !== ",") return; // browsers ignore a comma: 0,6 would become 6
    event.preventDefault();
    document.execCommand("insertText", false, ".");
  });
  range.setAttribute("aria-label", `${label}, slider`);
  number.setAttribute("aria-label", `${label} in ${unit}`);
  mark.className = "unit";
  mark.textContent = unit;
  line.append(name, range, number, mark);
  return { line, range, number };
}
