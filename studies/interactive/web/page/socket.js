// The web socket: hello with the token, events up, states and pictures down; it comes back by itself.
const WAITS = [500, 1000, 2000, 5000];
// Refusals of what the page sends, in this time [ms], after which it does not come back.
const MOST_REFUSED = 3,
  WITHIN = 30000;

function token() {
  const found = /(?:^#|&)token=([\w-]+)/.exec(location.hash);
  if (found) {
    sessionStorage.setItem("token", found[1]);
    const rest = location.hash.replace(/(^#|&)token=[\w-]+&?/, "$1").replace(/^#$/, "");
    history.replaceState(null, "", location.pathname + rest);
  }
  return sessionStorage.getItem("token") ?? "";
}

export class Socket {
  constructor(received, lost) {
    this.received = received;
    this.lost = lost;
    this.tries = 0;
    this.refused = [];
    this.token = token();
  }

  open() {
    this.socket = new WebSocket(`ws://${location.host}/ws`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => this.send({ do: "hello", version: 1, token: this.token });
    this.socket.onmessage = (event) => this.take(event.data);
    this.socket.onclose = (event) => this.closed(event);
  }

  get ready() {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  send(event) {
    if (this.ready) this.socket.send(event instanceof Uint8Array ? event : JSON.stringify(event));
  }

  async take(data) {
    this.tries = 0;
    if (typeof data === "string") return this.received(JSON.parse(data), null);
    const length = new DataView(data).getUint32(0, true);
    const message = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    const picture = await createImageBitmap(new Blob([new Uint8Array(data, 4 + length)], { type: "image/jpeg" }));
    this.received(message, picture);
    this.send({ do: "shown" });
  }

  closed(event) {
    if (event.code === 4403) return this.lost("The token does not fit: open the address that the command printed.");
    if (event.code === 4429) return this.lost("Too many pages are open: close one and load this one again.");
    if (event.code === 4400)
      this.refused = [...this.refused.filter((time) => performance.now() - time < WITHIN), performance.now()];
    if (this.refused.length >= MOST_REFUSED)
      return this.lost(
        `The server refuses what this page sends (${event.reason}): open the address that the command printed.`,
      );
    const why = event.code === 4400 ? ` (${event.reason})` : "";
    this.lost(`The server does not answer${why}: the last state is kept, trying again.`);
    setTimeout(() => this.open(), WAITS[Math.min(this.tries++, WAITS.length - 1)]);
  }
}
