// The browser's camera: grey pictures up, at most two on their way; each waits here for its state.
const IN_FLIGHT = 2,
  HEAD = 20;
const REASONS = {
  NotFoundError: "No camera was found.",
  NotAllowedError: "The camera was not allowed: allow it beside the address, then load the page again.",
  NotReadableError: "The camera is used by another program.",
  OverconstrainedError: "The camera does not offer this size.",
};

export class Camera {
  constructor(socket, say) {
    this.socket = socket;
    this.say = say;
    this.waiting = new Map();
    this.seq = 0;
    this.video = document.createElement("video");
    this.video.muted = this.video.playsInline = true;
  }

  async start(failed, device) {
    this.stop();
    if (!navigator.mediaDevices) return failed("A browser opens its camera to pages of its own machine only.");
    try {
      const size = { width: { ideal: 640 }, height: { ideal: 480 }, frameRate: { ideal: 25 } };
      this.stream = await navigator.mediaDevices.getUserMedia({
        video: device ? { ...size, deviceId: { exact: device } } : size,
      });
    } catch (error) {
      return failed(REASONS[error.name] ?? `The camera does not start (${error.name}).`);
    }
    this.video.srcObject = this.stream;
    await this.video.play();
    this.stream
      .getVideoTracks()[0]
      .addEventListener("ended", () => this.say("The camera was unplugged or switched off."));
    await this.list();
    this.next();
  }

  stop() {
    for (const track of this.stream?.getTracks() ?? []) track.stop();
    this.stream = null;
    this.waiting.clear();
  }

  async list() {
    const select = document.getElementById("camera");
    const devices = (await navigator.mediaDevices.enumerateDevices()).filter(
      (device) => device.kind === "videoinput",
    );
    const now = this.stream.getVideoTracks()[0].getSettings().deviceId;
    select.replaceChildren(
      ...devices.map((device, i) => new Option(`camera ${i + 1}`, device.deviceId, false, device.deviceId === now)),
    );
  }

  next() {
    this.video.requestVideoFrameCallback((now, data) => this.grab(now, data));
  }

  // Grey levels as they are: a browser codes a JPEG when it has nothing else to do, which takes longer than all
  // on this machine, where alone a camera opens.
  grab(now, data) {
    if (!this.stream) return;
    this.next();
    const { videoWidth: width, videoHeight: height } = this.video;
    if (this.waiting.size >= IN_FLIGHT || !this.socket.ready || !width) return;
    const seq = (this.seq = (this.seq + 1) % 2 ** 32);
    const picture = new OffscreenCanvas(width, height),
      context = picture.getContext("2d", { alpha: false, willReadFrequently: true });
    context.drawImage(this.video, 0, 0);
    this.waiting.set(seq, picture);
    const message = new Uint8Array(HEAD + width * height),
      head = new DataView(message.buffer);
    head.setUint8(0, 1);
    head.setUint8(1, 1);
    head.setUint32(4, seq, true);
    head.setUint16(8, width, true);
    head.setUint16(10, height, true);
    head.setFloat64(12, data.captureTime ?? now, true);
    grey(context.getImageData(0, 0, width, height).data, message.subarray(HEAD));
    this.socket.send(message);
  }

  picture(seq) {
    const picture = this.waiting.get(seq);
    this.waiting.delete(seq);
    return picture ?? null;
  }

  answered(seq) {
    for (const number of this.waiting.keys()) if (number < seq) this.waiting.delete(number);
  }
}

// Luma of colours by four bytes (ITU-R BT.601), in 65536ths.
function grey(colours, levels) {
  for (let k = 0, at = 0; k < levels.length; k++, at += 4)
    levels[k] = (19595 * colours[at] + 38470 * colours[at + 1] + 7471 * colours[at + 2] + 32768) >> 16;
}
