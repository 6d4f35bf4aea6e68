window.ways = [];
const captured = new Map();
window.WebSocket = class extends WebSocket {
  send(data) {
    if (data instanceof Uint8Array) {
      const head = new DataView(data.buffer);
      captured.set(head.getUint32(4, true), head.getFloat64(12, true));
    }
    super.send(data);
  }
};
let last = null;
const watch = () => {
  const seq = window.studio?.drawn?.seq;
  if (seq !== last && captured.has(seq)) window.ways.push(performance.now() - captured.get(seq));
  last = seq;
  requestAnimationFrame(watch);
};
watch();
