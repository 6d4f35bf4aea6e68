const coded = OffscreenCanvas.prototype.convertToBlob;
OffscreenCanvas.prototype.convertToBlob = async function (...words) {
  await new Promise((done) => setTimeout(done, 140));
  return coded.apply(this, words);
};
setInterval(() => { const end = performance.now() + 90; while (performance.now() < end); }, 130);
