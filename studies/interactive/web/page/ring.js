// The last minute of states, with small pictures, to scrub through, to plot and to export.
const SPAN = 60,
  MOST = 3000;
// Width [px] and quality of a picture that is kept, and how long before a state one may be that stands for it [s].
const WIDTH = 320,
  QUALITY = 0.6,
  BEFORE = 1;
// Part of the largest rate of rotation below which no centre is drawn: where a release begins to turn, the strips'
// quick vibration moves the body as much as the turn does.
const SLOW = 0.25;

export class Ring {
  constructor() {
    this.states = [];
    this.place = 0;
    this.live = true;
  }

  get length() {
    return this.states.length;
  }
  get current() {
    return this.states[this.place];
  }
  get age() {
    return this.states.length ? this.states[this.states.length - 1].at - this.current.at : 0;
  }
  // The trajectory of the centre of rotation in this design; undefined while the body hardly moves.
  get centres() {
    const now = this.current,
      recent = this.states
        .slice(Math.max(0, this.place - 300), this.place + 1)
        .filter((s) => s.centre && s.design === now.design);
    const most = Math.max(...recent.map((s) => Math.abs(s.velocity[2])));
    return recent.filter((s) => s.mode === "held" || Math.abs(s.velocity[2]) > SLOW * most).map((s) => s.centre);
  }

  add(state) {
    state.at = performance.now() / 1000;
    const { time_scale, ...design } = state.values;
    const kept = {
      ...state,
      design: JSON.stringify(design),
      sight: { state: state.sight.state, plane: state.sight.plane },
    };
    this.states.push(kept);
    while (this.states.length > MOST || (this.states.length && state.at - this.states[0].at > SPAN)) {
      this.states.shift();
      if (!this.live && this.place > 0) this.place -= 1;
    }
    if (this.live) this.place = this.states.length - 1;
  }

  // Keep a picture with the newest state, copied at once, coded when there is time.
  async film(picture) {
    const state = this.states[this.states.length - 1],
      { width, height } = picture,
      small = new OffscreenCanvas(WIDTH, Math.round((WIDTH * height) / width));
    small.getContext("2d", { alpha: false }).drawImage(picture, 0, 0, small.width, small.height);
    state.small = {
      size: [width, height],
      blob: await small.convertToBlob({ type: "image/jpeg", quality: QUALITY }),
    };
  }

  // The picture of the present place, or of shortly before.
  get small() {
    const now = this.current;
    return this.states
      .slice(Math.max(0, this.place - 50), this.place + 1)
      .reverse()
      .find((s) => s.small && now.at - s.at < BEFORE)?.small;
  }

  go(place) {
    this.place = Math.max(0, Math.min(this.states.length - 1, place));
    this.live = this.place === this.states.length - 1;
  }

  goLive() {
    this.go(this.states.length - 1);
  }
}
