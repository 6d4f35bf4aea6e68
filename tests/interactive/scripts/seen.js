window.seen = new Map();
const small = Object.assign(document.createElement("canvas"), { width: 96, height: 12 }).getContext("2d");
const watch = () => {
  if (studio.picture && studio.drawn?.seq === studio.state.seq) {
    small.drawImage(studio.picture, 0, 0);
    const data = small.getImageData(0, 6, 96, 1).data;
    let number = 0;
    for (let bit = 0; bit < 16; bit++) if (data[4 * (3 + 6 * bit)] > 127) number += 2 ** bit;
    window.seen.set(studio.state.seq, { number, marker: studio.state.placing.marker, codes:
    studio.state.warnings.map((w) => w.code),
      sight: studio.state.sight.state });
  }
  requestAnimationFrame(watch);
};
watch();
