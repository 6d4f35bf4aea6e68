// A small line plot: axes with round numbers, lines or dots.
const round = (span) => { const p = 10 ** Math.floor(Math.log10(span)), r = span / p; return p * (r < 1.5 ? 0.5 : r < 3.5 ? 1 : r < 7.5 ? 2 : 5); };
const tidy = (value, step) => Number(value.toFixed(Math.max(0, -Math.floor(Math.log10(step)) + 1))).toString();

export function plot(canvas, series, { x = null, fromZero = false, unitX = "", least = 1e-3 } = {}) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (!width) return;
  if (canvas.width !== Math.round(width * ratio)) { canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio); }
  const c = canvas.getContext("2d"), all = series.flatMap((s) => s.points);
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  if (!all.length) return;
  // What spans less than `span` is drawn in the middle of it, or from nought up.
  const range = (values, low, high, span) => {
    for (const v of values) { low = Math.min(low, v); high = Math.max(high, v); }
    const more = Math.max(0, span - (high - low));
    return low >= 0 && fromZero ? [low, high + more] : [low - more / 2, high + more / 2];
  };
  const [x0, x1] = x ?? range(all.map((p) => p[0]), Infinity, -Infinity, 1);
  let [y0, y1] = range(all.map((p) => p[1]), fromZero ? 0 : Infinity, -Infinity, least);
  y1 += 0.06 * (y1 - y0); if (!fromZero) y0 -= 0.06 * (y1 - y0);
  const left = 52, bottom = 20, right = 10, top = 6;
  const px = (v) => left + (v - x0) / (x1 - x0) * (width - left - right), py = (v) => height - bottom - (v - y0) / (y1 - y0) * (height - top - bottom);
  c.font = "11px system-ui, sans-serif"; c.fillStyle = "#b3bfca"; c.strokeStyle = "#38424d"; c.lineWidth = 1;
  const sx = round((x1 - x0) / 2.2), sy = round((y1 - y0) / 1.6);
  c.textAlign = "center";
  for (let v = Math.ceil(x0 / sx) * sx; v <= x1 + 1e-9; v += sx) {
    c.beginPath(); c.moveTo(px(v), top); c.lineTo(px(v), height - bottom); c.stroke();
    c.fillText(`${tidy(v, sx)} ${unitX}`, Math.min(px(v), width - 22), height - 5);
  }
  c.textAlign = "right";
  for (let v = Math.ceil(y0 / sy) * sy; v <= y1; v += sy) {
    c.beginPath(); c.moveTo(left, py(v)); c.lineTo(width - right, py(v)); c.stroke();
    c.fillText(tidy(v, sy), left - 5, py(v) + 4);
  }
  for (const { points, colour, dots } of series) {
    c.strokeStyle = c.fillStyle = colour; c.lineWidth = 1.6;
    c.beginPath();
    points.forEach(([u, v], k) => (dots ? c.fillRect(px(u) - 1, py(v) - 1, 2, 2) : k ? c.lineTo(px(u), py(v)) : c.moveTo(px(u), py(v))));
    if (!dots) c.stroke();
    else { const [u, v] = points[points.length - 1] ?? []; if (u !== undefined) { c.arc(px(u), py(v), 3.5, 0, 7); c.fill(); } }
  }
}
