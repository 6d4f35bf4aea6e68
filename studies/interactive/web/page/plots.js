// A small line plot: axes with round numbers, lines, dots, limits, and one point that is now.
const round = (span) => {
  const p = 10 ** Math.floor(Math.log10(span)),
    r = span / p;
  return p * (r < 1.5 ? 0.5 : r < 3.5 ? 1 : r < 7.5 ? 2 : 5);
};
const tidy = (value, step) => Number(value.toFixed(Math.max(0, -Math.floor(Math.log10(step)) + 1))).toString();
// Colours of the page's own names, whatever scheme it is shown in.
const known = new Map();
for (const media of ["(prefers-color-scheme: light)", "(prefers-contrast: more)", "(forced-colors: active)"]) {
  matchMedia(media).addEventListener("change", () => known.clear());
}
function hue(name) {
  if (!known.has(name)) known.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return known.get(name);
}

export function plot(
  canvas,
  series,
  { x = null, y = null, fromZero = false, unitX = "", least = 1e-3, limits = [] } = {},
) {
  const ratio = window.devicePixelRatio || 1,
    width = canvas.clientWidth,
    height = canvas.clientHeight;
  if (!width) return;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const c = canvas.getContext("2d"),
    all = series.flatMap((s) => s.points);
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  if (!all.length) return;
  // What spans less than `span` is drawn in the middle of it, or from nought up.
  const range = (values, low, high, span) => {
    for (const v of values) {
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
    const more = Math.max(0, span - (high - low));
    return low >= 0 && fromZero ? [low, high + more] : [low - more / 2, high + more / 2];
  };
  const [x0, x1] =
    x ??
    range(
      all.map((p) => p[0]),
      Infinity,
      -Infinity,
      1,
    );
  let [y0, y1] =
    y ??
    range(
      all.map((p) => p[1]),
      fromZero ? 0 : Infinity,
      -Infinity,
      least,
    );
  y1 += 0.06 * (y1 - y0);
  if (!fromZero) y0 -= 0.06 * (y1 - y0);
  const left = 52,
    bottom = 20,
    right = 10,
    top = 6;
  const px = (v) => left + ((v - x0) / (x1 - x0)) * (width - left - right),
    py = (v) => height - bottom - ((v - y0) / (y1 - y0)) * (height - top - bottom);
  c.font = "11px system-ui, sans-serif";
  c.fillStyle = hue("--quiet");
  c.strokeStyle = hue("--line");
  c.lineWidth = 1;
  const sx = round((x1 - x0) / 2.2),
    sy = round((y1 - y0) / 1.6);
  c.textAlign = "center";
  for (let v = Math.ceil(x0 / sx) * sx; v <= x1 + 1e-9; v += sx) {
    c.beginPath();
    c.moveTo(px(v), top);
    c.lineTo(px(v), height - bottom);
    c.stroke();
    c.fillText(`${tidy(v, sx)} ${unitX}`, Math.min(px(v), width - 22), height - 5);
  }
  c.textAlign = "right";
  for (let v = Math.ceil(y0 / sy) * sy; v <= y1; v += sy) {
    c.beginPath();
    c.moveTo(left, py(v));
    c.lineTo(width - right, py(v));
    c.stroke();
    c.fillText(tidy(v, sy), left - 5, py(v) + 4);
  }
  c.save();
  c.beginPath();
  c.rect(left, top, width - left - right, height - top - bottom);
  c.clip();
  c.strokeStyle = hue("--bad");
  c.setLineDash([3, 3]);
  for (const v of limits) {
    c.beginPath();
    c.moveTo(px(v), top);
    c.lineTo(px(v), height - bottom);
    c.stroke();
  }
  for (const { points, colour, dots, dashed, now } of series) {
    c.strokeStyle = c.fillStyle = hue(colour);
    c.lineWidth = 1.6;
    c.setLineDash(dashed ? [5, 4] : []);
    c.beginPath();
    points.forEach(([u, v], k) =>
      dots
        ? c.fillRect(px(u) - 1, py(v) - 1, 2, 2)
        : now
          ? (c.arc(px(u), py(v), 4, 0, 7), c.fill())
          : k
            ? c.lineTo(px(u), py(v))
            : c.moveTo(px(u), py(v)),
    );
    if (!dots && !now) c.stroke();
  }
  c.restore();
}
