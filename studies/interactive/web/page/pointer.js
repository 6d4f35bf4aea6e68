// Mouse and touch on the picture: drag turns the body, or moves it where its whole pose is held; two fingers do both.
// While the design is shaped, a clamp that is dragged takes length, inclination and crossing with it.
const WHEEL = (0.5 * Math.PI) / 180;
// Between two poses [ms]: a screen of 60 Hz sends each, one of 144 Hz every second.
const SHORTEST = 12;
// How near to a clamp a mouse and a finger take hold of it [px].
const REACH = 14,
  FINGER = 30;

export class Pointer {
  constructor(canvas, view, studio, send, controls, redraw) {
    Object.assign(this, {
      canvas,
      view,
      studio,
      send,
      controls,
      redraw,
      panned: null,
      on: false,
      down: new Map(),
      start: null,
      waiting: null,
      clamp: null,
    });
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, (event) => this.lift(event));
    canvas.addEventListener(
      "wheel",
      (event) => {
        if (this.on) {
          event.preventDefault();
          this.turn(event);
        }
      },
      { passive: false },
    );
  }

  get held() {
    return this.on && this.studio.state?.mode === "held";
  }

  // The wheel turns the body; with Ctrl it zooms.
  turn(event) {
    if (!event.ctrlKey) return this.nudge([0, 0, -Math.sign(event.deltaY) * WHEEL]);
    this.view.zoom(event.deltaY < 0 ? 1.1 : 1 / 1.1, event.clientX, event.clientY);
    this.redraw();
  }

  press(event) {
    if (this.on && (event.ctrlKey || event.button === 1)) {
      this.canvas.setPointerCapture(event.pointerId);
      this.panned = event.pointerId;
      return;
    }
    const clamp =
      this.view.shaping && this.studio.state.values.length && !this.down.size ? this.nearest(event) : null;
    if (!this.on && !clamp) this.controls.say("The markers in the picture move the body.");
    if (!clamp && !this.held) return;
    const { bodies, body } = this.studio.state.placing,
      other = this.view.bodyAt(this.studio.state, event.clientX, event.clientY, this.reach(event));
    if (!clamp && other >= 0 && other !== body) return this.send({ do: "grasp", body: bodies[other] });
    // The first finger takes hold of the body: a swipe beside it is no drag.
    if (!clamp && other < 0 && event.pointerType === "touch" && !this.down.size) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.canvas.focus();
    if (clamp) {
      this.clamp = { id: event.pointerId, end: clamp };
      this.view.freeze(this.studio.state);
      return;
    }
    this.down.set(event.pointerId, this.view.from(event.clientX, event.clientY));
    this.begin();
  }

  begin() {
    this.start = {
      at: new Map(this.down),
      wanted: [...(this.studio.state.grip !== null ? this.studio.state.wanted : this.studio.state.displacement)],
      pose: [...this.studio.state.pose],
    };
  }

  move(event) {
    if (this.panned === event.pointerId) {
      this.view.pan(event.movementX, event.movementY);
      return this.redraw();
    }
    if (this.clamp?.id === event.pointerId)
      return this.shape(this.view.from(event.clientX, event.clientY), this.clamp.end);
    if (!this.down.has(event.pointerId) || !this.held) return;
    this.down.set(event.pointerId, this.view.from(event.clientX, event.clientY));
    this.post(this.down.size > 1 ? this.two() : this.one(event.shiftKey));
  }

  lift(event) {
    if (this.panned === event.pointerId) this.panned = null;
    if (this.clamp?.id === event.pointerId) {
      this.clamp = null;
      this.view.freeze(null);
      this.controls.ended();
    }
    this.down.delete(event.pointerId);
    if (this.down.size) this.begin();
  }

  // The strip and end, as [strip, end], of the clamp that a pointer takes hold of.
  nearest(event) {
    const near = [0, 1]
      .flatMap((strip) =>
        [0, 1].map((end) => {
          const [x, y] = this.view.page(...this.view.clamp(this.studio.state, strip, end));
          return [Math.hypot(x - event.clientX, y - event.clientY), [strip, end]];
        }),
      )
      .sort((p, q) => p[0] - q[0])[0];
    return near[0] <= this.reach(event) ? near[1] : null;
  }

  reach(event) {
    return event.pointerType === "touch" ? FINGER : REACH;
  }

  // Half the ground, half the body and the height between them are what a clamp changes; both sides stay alike.
  shape([x, y], [strip, end]) {
    const s = this.studio.state,
      [a, b] = s.placing.clamps,
      mid = (a[0][0] + b[0][0]) / 2,
      side = strip === end ? -1 : 1;
    let ground = mid - a[0][0],
      body = a[1][0] - mid,
      high = a[1][1];
    if (end) {
      const [x0, y0] = s.placing.centre,
        cos = Math.cos(s.pose[2]),
        sin = Math.sin(s.pose[2]),
        dx = x - s.pose[0],
        dy = y - s.pose[1];
      [x, y] = [x0 + cos * dx + sin * dy, y0 - sin * dx + cos * dy];
      high = y;
    }
    const half = Math.max(1e-3, side * (x - mid));
    if (end) body = half;
    else ground = half;
    const values = { ...s.values },
      wide = ground + body;
    const wanted = {
      length: Math.hypot(wide, high),
      inclination: Math.atan2(Math.max(1e-3, high), wide),
      crossing_ratio: ground / wide,
    };
    for (const [name, value] of Object.entries(wanted)) values[name] = this.controls.within(name, value);
    this.controls.change({ do: "preset", name: s.preset, values }, "shape", false);
  }

  one(shift) {
    const [id] = this.down.keys(),
      p = this.start.at.get(id),
      q = this.down.get(id),
      [dx, dy, t] = this.start.wanted;
    if (this.studio.state.drive !== "rotation" && !shift) return [dx + q[0] - p[0], dy + q[1] - p[1], t];
    const clamps = this.studio.state.placing.clamps.flat();
    const centre = [0, 1].map((i) => clamps.reduce((sum, clamp) => sum + clamp[i], 0) / clamps.length);
    return [dx, dy, t + turn(p, q, this.studio.state.drive === "rotation" ? centre : this.start.pose)];
  }

  two() {
    const [a, b] = this.down.keys(),
      s = this.start.at,
      d = this.down,
      [dx, dy, t] = this.start.wanted;
    const before = [s.get(b)[0] - s.get(a)[0], s.get(b)[1] - s.get(a)[1]],
      after = [d.get(b)[0] - d.get(a)[0], d.get(b)[1] - d.get(a)[1]];
    const angle = Math.atan2(
      before[0] * after[1] - before[1] * after[0],
      before[0] * after[0] + before[1] * after[1],
    );
    const mid = (m) => [(m.get(a)[0] + m.get(b)[0]) / 2, (m.get(a)[1] + m.get(b)[1]) / 2],
      p = mid(s),
      q = mid(d);
    return [dx + q[0] - p[0], dy + q[1] - p[1], t + angle];
  }

  nudge(change) {
    if (!this.held) return;
    const answered = this.seq === undefined || this.last === undefined || (this.studio.state.seq ?? -1) >= this.seq;
    const wanted = this.next ?? (answered ? this.studio.state.wanted : this.last);
    this.next = wanted.map((value, k) => value + change[k]);
    if (this.waiting || this.early) this.post(this.next);
    else this.flush(); // a key waits for no frame, as pointers do that come in step with them
  }

  get early() {
    return performance.now() - (this.seq ?? -SHORTEST) < SHORTEST;
  }

  // One pose a drawn frame, on a fast screen every second or third: the newest wins.
  post(pose) {
    this.next = pose;
    if (this.waiting) return;
    const drawn = () => {
      this.waiting = this.early ? requestAnimationFrame(drawn) : null;
      if (!this.waiting) this.flush();
    };
    this.waiting = requestAnimationFrame(drawn);
  }

  // What the server says counts again.
  forget() {
    this.seq = undefined;
  }

  // Numbered, so that steps that follow faster than the answers add up.
  flush() {
    this.seq = performance.now();
    this.last = this.next;
    this.send({ do: "pose", pose: this.next, seq: this.seq });
    this.next = null;
  }
}

function turn(p, q, centre) {
  const a = [p[0] - centre[0], p[1] - centre[1]],
    b = [q[0] - centre[0], q[1] - centre[1]];
  return Math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}
