window.sockets = 0;
window.WebSocket = class extends WebSocket {
  constructor(...words) { super(...words); window.sockets += 1; }
};
