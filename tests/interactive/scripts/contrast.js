(() => {
  const linear = (x) => (x / 255 <= 0.03928 ? x / 255 / 12.92 : ((x / 255 + 0.055) / 1.055) ** 2.4);
  const light = (c) => 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
  const parse = (text) => text.match(/[\d.]+/g).map(Number);
  const back = (e) => {
    for (; e; e = e.parentElement) {
      const colour = parse(getComputedStyle(e).backgroundColor);
      if (colour.length < 4 || colour[3] > 0) return colour;
    }
    return [255, 255, 255];
  };
  const worded = (e) => [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
  const shown = [...document.querySelectorAll("body *")].filter((e) => worded(e) && e.offsetParent
    && !e.closest(":disabled"));
  const found = shown.map((e) => {
    const pair = [light(parse(getComputedStyle(e).color)), light(back(e))];
    const ratio = (Math.max(...pair) + 0.05) / (Math.min(...pair) + 0.05);
    return [ratio, e.id || e.textContent.trim().slice(0, 20)];
  });
  return found.sort((p, q) => p[0] - q[0])[0];
})()
