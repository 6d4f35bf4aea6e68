((x0, y0, x1, y1) => { const s = studio.state.placing.clamps, v = studio.view;
  const c = [(s[0][0][0] + s[1][0][0]) / 2, (s[0][0][1] + s[0][1][1]) / 2];
  const [p, q] = [v.from(x0, y0), v.from(x1, y1)].map(([a, b]) => Math.atan2(b - c[1], a - c[0]));
  return q - p; })
