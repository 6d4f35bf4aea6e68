// The picture with the pivot over it. Places are in the pivot's frame [m]; a homography takes them to pixels.
const COLOURS = {
  ground: "#00e5ff",
  moving: "#ff2bd6",
  plate: "#dfe6ec",
  base: "#9fb0bf",
  path: "#7dff6a",
  load: "#ffb000",
};
const WIDTH = 640,
  HEIGHT = 480;
// Least width of a strip on the picture [px], and colours from no stress to yield.
const THINNEST = 2.5,
  STRESS = [
    [47, 127, 214],
    [64, 190, 170],
    [242, 209, 60],
    [255, 59, 48],
  ];

function stressed(share) {
  const place = 3 * Math.min(0.9999, share),
    k = Math.floor(place),
    part = place - k;
  return `rgb(${STRESS[k].map((low, i) => Math.round(low + part * (STRESS[k + 1][i] - low))).join()})`;
}

// Distance of a place from a chord, all [px].
function apart([x, y], [x0, y0], [x1, y1]) {
  const [dx, dy] = [x1 - x0, y1 - y0],
    square = dx * dx + dy * dy,
    u = square ? Math.max(0, Math.min(1, ((x - x0) * dx + (y - y0) * dy) / square)) : 0;
  return Math.hypot(x - x0 - u * dx, y - y0 - u * dy);
}

const multiply = (a, b) =>
  [0, 3, 6].flatMap((r) => [0, 1, 2].map((c) => a[r] * b[c] + a[r + 1] * b[c + 3] + a[r + 2] * b[c + 6]));

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.plane = null;
    this.home();
    this.size = [WIDTH, HEIGHT];
    this.wide = canvas.clientWidth;
    new ResizeObserver(() => {
      this.wide = canvas.clientWidth;
    }).observe(canvas);
    this.resize();
  }

  // Of the picture's units to one of the screen's [px]: lines, dots and words are as large on every screen.
  get pen() {
    return this.size[0] / (this.wide || this.size[0]);
  }
  dash(...lengths) {
    this.context.setLineDash(lengths.map((length) => length * this.pen));
  }

  resize() {
    const scale = Math.max(1, Math.min(3, Math.ceil(1280 / this.size[0])));
    if (this.canvas.width === this.size[0] * scale && this.canvas.height === this.size[1] * scale) return;
    this.scale = scale;
    this.canvas.width = this.size[0] * scale;
    this.canvas.height = this.size[1] * scale;
  }

  // Without a picture: the rest place of both plates in the middle, millimetres alike in x and y.
  own(state) {
    const { zoom, y } = this.frozen ?? this.scaled(state),
      { x } = this.scaled(state),
      { k, dx, dy } = this.look,
      s = k * zoom;
    return [s, 0, this.size[0] / 2 + dx - s * x, 0, -s, this.size[1] / 2 + dy + k * 0.06 * HEIGHT + s * y, 0, 0, 1];
  }

  // The scale and the middle at which clamps and body fill the picture.
  scaled({ placing: { clamps, centre, length } }) {
    const places = [...clamps.flat(), centre];
    const [x, y] = [0, 1]
      .map((i) => places.map((place) => place[i]))
      .map((all) => [Math.min(...all), Math.max(...all)]);
    const high = Math.max(y[1] - y[0], 0.1 * length),
      wide = Math.max(x[1] - x[0], 0.1 * length);
    return {
      zoom: Math.min((0.4 * HEIGHT) / high, (0.45 * WIDTH) / wide),
      x: (x[0] + x[1]) / 2,
      y: (y[0] + y[1]) / 2,
    };
  }

  // Zoom about a place on the page, or the middle.
  zoom(factor, clientX, clientY) {
    const box = this.canvas.getBoundingClientRect(),
      look = this.look;
    const u = clientX === undefined ? 0 : ((clientX - box.left) / box.width - 0.5) * this.size[0];
    const v = clientY === undefined ? 0 : ((clientY - box.top) / box.height - 0.5) * this.size[1];
    const k = Math.max(0.05, Math.min(50, look.k * factor)),
      f = k / look.k;
    this.look = { k, dx: u - f * (u - look.dx), dy: v - f * (v - look.dy) };
  }

  // Move the picture by a way on the page [px].
  pan(x, y) {
    const box = this.canvas.getBoundingClientRect();
    this.look.dx += (x / box.width) * this.size[0];
    this.look.dy += (y / box.height) * this.size[1];
  }

  home() {
    this.look = { k: 1, dx: 0, dy: 0 };
  }

  // As long as a clamp of this state is dragged, scale and height stay.
  freeze(state) {
    this.frozen = state && this.scaled(state);
  }

  choose(state, picture) {
    if (picture) {
      this.size = picture.size ?? [picture.width, picture.height];
      if (state.sight.plane) {
        const [gx, gy] = state.placing.ground;
        this.plane = multiply(state.sight.plane, [1, 0, -gx, 0, 1, -gy, 0, 0, 1]);
      }
    } else if (state.sight.state === "none" || !this.plane) this.plane = this.own(state);
    this.resize();
  }

  // Pixel centres have whole coordinates in the homography and half ones on a canvas.
  to(x, y) {
    const h = this.plane,
      w = h[6] * x + h[7] * y + h[8];
    return [(h[0] * x + h[1] * y + h[2]) / w + 0.5, (h[3] * x + h[4] * y + h[5]) / w + 0.5];
  }

  // From a pointer's place on the page to the pivot's frame.
  from(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect(),
      h = this.plane;
    const u = ((clientX - box.left) / box.width) * this.size[0] - 0.5,
      v = ((clientY - box.top) / box.height) * this.size[1] - 0.5;
    const a = h[0] - u * h[6],
      b = h[1] - u * h[7],
      c = u * h[8] - h[2],
      d = h[3] - v * h[6],
      e = h[4] - v * h[7],
      f = v * h[8] - h[5];
    const det = a * e - b * d;
    return [(c * e - b * f) / det, (a * f - c * d) / det];
  }

  // From the pivot's frame to a place on the page.
  page(x, y) {
    const box = this.canvas.getBoundingClientRect(),
      [u, v] = this.to(x, y);
    return [box.left + (u / this.size[0]) * box.width, box.top + (v / this.size[1]) * box.height];
  }

  // A place that moves with a body, the held one by default, by its place at rest; the ground is -1.
  moved(state, [px, py], body = state.placing.body) {
    if (body < 0) return [px, py];
    const [x, y, t] = state.poses[body],
      [x0, y0] = state.placing.centres[body],
      cos = Math.cos(t),
      sin = Math.sin(t);
    return [x + cos * (px - x0) - sin * (py - y0), y + sin * (px - x0) + cos * (py - y0)];
  }

  clamp(state, strip, end) {
    return this.moved(state, state.placing.clamps[strip][end], state.placing.ends[strip][end]);
  }

  // The body at a place on the page, by the chords between its clamps; -1 for the ground or none.
  bodyAt(state, clientX, clientY, reach) {
    const { clamps, ends, bodies } = state.placing;
    const far = bodies.map((_, k) => {
      const all = clamps.flatMap((strip, s) =>
        [0, 1].filter((end) => ends[s][end] === k).map((end) => this.page(...this.clamp(state, s, end))),
      );
      return Math.min(...all.map((place) => apart([clientX, clientY], all[0], place)));
    });
    const nearest = far.indexOf(Math.min(...far));
    return far[nearest] <= reach ? nearest : -1;
  }

  draw(state, picture, centres) {
    this.choose(state, picture);
    const c = this.context,
      stale = state.warnings.some((w) =>
        ["no-equilibrium", "absurd", "jump", "lost-0", "lost-1", "lost-both"].includes(w.code),
      );
    c.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    if (picture) c.drawImage(picture, 0, 0, ...this.size);
    else {
      c.fillStyle = "#0c0f12";
      c.fillRect(0, 0, ...this.size);
      if (this.plane) this.grid();
    }
    if (!this.plane) return;
    this.outlines(state);
    this.plates(state);
    for (const [x, y] of centres.slice(-150)) this.dot(x, y, 1.3, COLOURS.path);
    state.shape.forEach((strip, s) => {
      if (stale) this.dash(6, 5);
      this.strip(strip, state.stress.along[s], state.placing.depth[s]);
      this.dash();
    });
    this.pull(state);
    if (state.centre) this.cross(...state.centre, COLOURS.path);
    this.dot(state.pose[0], state.pose[1], 3.5, COLOURS.plate);
    this.load(state);
    if (this.shaping && state.values.length)
      for (const strip of [0, 1]) for (const end of [0, 1]) this.handle(...this.clamp(state, strip, end));
    if (this.caption) this.words(state);
  }

  handle(x, y) {
    for (const [colour, width] of [
      ["#000", 5],
      [COLOURS.plate, 2.5],
    ]) {
      const c = this.context;
      c.beginPath();
      c.arc(...this.to(x, y), 7 * this.pen, 0, 7);
      c.strokeStyle = colour;
      c.lineWidth = width * this.pen;
      c.stroke();
    }
  }

  // An arrow for the load on the body's centre, as long whatever it is.
  load(state) {
    const down = Math.sign(state.values.load),
      [x, y] = state.pose,
      long = 0.18 * state.placing.length;
    if (!down) return;
    const tip = y - down * long,
      wing = 0.25 * long;
    this.line(
      [
        [x, y],
        [x, tip],
      ],
      COLOURS.load,
      3,
    );
    this.line(
      [
        [x - wing / 2, tip + down * wing],
        [x, tip],
        [x + wing / 2, tip + down * wing],
      ],
      COLOURS.load,
      3,
    );
  }

  // What a picture or a video says by itself.
  words(state) {
    const c = this.context;
    c.font = "13px system-ui, sans-serif";
    c.fillStyle = "#000c";
    c.fillRect(0, 0, this.size[0], 20);
    c.fillStyle = "#fff";
    c.fillText(`${state.status} Strips ${Number((1e3 * state.placing.length).toPrecision(3))} mm long.`, 8, 14);
  }

  // A strip at its thickness in the picture, its colour that of the stress at the places along it: a gradient
  // from end to end, for a stroke by itself for each part takes longer than all else.
  strip(places, stress, thickness) {
    const [x, y] = places[Math.floor(places.length / 2)],
      [u, v] = this.to(x, y),
      [p, q] = this.to(x + thickness, y);
    const width = Math.max(THINNEST, Math.hypot(p - u, q - v) / this.pen),
      [x0, y0] = this.to(...places[0]),
      [x1, y1] = this.to(...places[places.length - 1]);
    const colour = this.context.createLinearGradient(x0, y0, x1, y1),
      chord = (x1 - x0) ** 2 + (y1 - y0) ** 2;
    places.forEach(([a, b], k) => {
      const [m, n] = this.to(a, b),
        share = ((m - x0) * (x1 - x0) + (n - y0) * (y1 - y0)) / chord;
      if (k % 3 === 0) colour.addColorStop(Math.min(1, Math.max(0, share)), stressed(stress[k]));
    });
    this.line(places, "#000a", width + 3);
    this.line(places, colour, width);
  }

  // From the body's centre to where the hand pulls, where that is not the same place.
  pull(state) {
    const [x0, y0] = state.placing.centre,
      [x, y] = state.wanted;
    if (state.grip === null || Math.hypot(x - state.displacement[0], y - state.displacement[1]) < 5e-4) return;
    this.dash(4, 4);
    this.line(
      [
        [state.pose[0], state.pose[1]],
        [x0 + x, y0 + y],
      ],
      COLOURS.moving,
      2,
    );
    this.dash();
    this.dot(x0 + x, y0 + y, 3.5, COLOURS.moving);
  }

  grid() {
    const c = this.context,
      pen = this.pen;
    const box = this.canvas.getBoundingClientRect(),
      [x0, y1] = this.from(box.left, box.top),
      [x1, y0] = this.from(box.right, box.bottom);
    const step = 10 ** Math.ceil(Math.log10(Math.abs(x1 - x0) / 40));
    for (let k = Math.floor(x0 / step); k <= x1 / step; k++)
      this.line(
        [
          [k * step, y0],
          [k * step, y1],
        ],
        "#20272e",
        1,
      );
    for (let k = Math.floor(y0 / step); k <= y1 / step; k++)
      this.line(
        [
          [x0, k * step],
          [x1, k * step],
        ],
        "#20272e",
        1,
      );
    c.fillStyle = "#94a3b1";
    c.font = `${12 * pen}px system-ui, sans-serif`;
    c.fillText(`grid ${Number((1e3 * step).toPrecision(2))} mm`, 10 * pen, this.size[1] - 10 * pen);
  }

  outlines(state) {
    const c = this.context;
    (state.sight.quads ?? []).forEach((quad, i) => {
      c.beginPath();
      quad.forEach(([x, y], k) => (k ? c.lineTo(x + 0.5, y + 0.5) : c.moveTo(x + 0.5, y + 0.5)));
      c.closePath();
      c.strokeStyle = i ? COLOURS.moving : COLOURS.ground;
      c.lineWidth = 1.5 * this.pen;
      c.stroke();
    });
  }

  plates(state) {
    const { clamps, ends, centre, centres, length, body } = state.placing,
      moved = (place) => this.moved(state, place),
      over = 0.07 * length;
    // From the first clamp of a body to the last, and a little farther; across the strip where there is only one.
    const bar = (owner) => {
      const own = clamps.flatMap((strip, s) =>
          strip.flatMap((place, end) => (ends[s][end] === owner ? [[place, strip]] : [])),
        ),
        all = own.map(([place]) => place),
        p = all[0],
        q = all[all.length - 1],
        along = own[0][1];
      const way =
        all.length > 1 ? [q[0] - p[0], q[1] - p[1]] : [along[0][1] - along[1][1], along[1][0] - along[0][0]];
      const d = Math.hypot(...way) || 1,
        [ex, ey] = way.map((part) => (part / d) * over);
      return [
        [p[0] - ex, p[1] - ey],
        [q[0] + ex, q[1] + ey],
      ];
    };
    this.line(bar(-1), COLOURS.base, 7);
    centres.forEach((_, k) =>
      this.line(
        bar(k).map((place) => this.moved(state, place, k)),
        k === body ? COLOURS.plate : COLOURS.base,
        7,
      ),
    );
    if (state.mode !== "released" && state.sight.state !== "none") return;
    const tips = clamps.flatMap((strip, s) => strip.filter((_, end) => ends[s][end] === body)),
      mid = [0, 1].map((i) => tips.reduce((sum, tip) => sum + tip[i], 0) / tips.length);
    const far = Math.hypot(centre[0] - mid[0], centre[1] - mid[1]) > 0.05 * length;
    this.line([moved(mid), moved(far ? centre : [mid[0], mid[1] + 0.24 * length])], COLOURS.plate, 3);
  }

  line(points, colour, width) {
    const c = this.context;
    c.beginPath();
    points.forEach(([x, y], k) => (k ? c.lineTo(...this.to(x, y)) : c.moveTo(...this.to(x, y))));
    c.strokeStyle = colour;
    c.lineWidth = width * this.pen;
    c.lineJoin = "round";
    c.lineCap = "butt";
    c.stroke();
  }

  dot(x, y, radius, colour) {
    const c = this.context;
    c.beginPath();
    c.arc(...this.to(x, y), radius * this.pen, 0, 7);
    c.fillStyle = colour;
    c.fill();
  }

  cross(x, y, colour) {
    const c = this.context,
      [u, v] = this.to(x, y),
      arm = 7 * this.pen;
    c.beginPath();
    c.moveTo(u - arm, v);
    c.lineTo(u + arm, v);
    c.moveTo(u, v - arm);
    c.lineTo(u, v + arm);
    c.strokeStyle = colour;
    c.lineWidth = 1.5 * this.pen;
    c.stroke();
  }
}
