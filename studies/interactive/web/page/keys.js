// Every key and what it does: the same table drives the keyboard and the list on "?".
const DEGREE = Math.PI / 180;
const KEYS = [
  ["R", "release, or catch", (a) => a.release()],
  [" ", "pause and resume", (a) => a.pause(), "Space"],
  ["0", "reset to rest", (a) => a.reset()],
  [
    "ArrowLeft",
    "turn by 1°; with Shift move by a thousandth of the strips' length",
    (a, s) => (s ? a.move(-1, 0) : a.turn(DEGREE)),
    "←",
  ],
  [
    "ArrowRight",
    "turn back by 1°; with Shift move by a thousandth of the strips' length",
    (a, s) => (s ? a.move(1, 0) : a.turn(-DEGREE)),
    "→",
  ],
  [
    "ArrowUp",
    "turn by 5°; with Shift move by a thousandth of the strips' length",
    (a, s) => (s ? a.move(0, 1) : a.turn(5 * DEGREE)),
    "↑",
  ],
  [
    "ArrowDown",
    "turn back by 5°; with Shift move by a thousandth of the strips' length",
    (a, s) => (s ? a.move(0, -1) : a.turn(-5 * DEGREE)),
    "↓",
  ],
  ["M", "next set of prescribed coordinates", (a) => a.drive()],
  ["[", "back in the last minute", (a) => a.back()],
  ["]", "forth in the last minute", (a) => a.forth()],
  ["L", "back to live", (a) => a.live()],
  ["E", "shape the design by its clamps, or no longer", (a) => a.shape()],
  ["+", "zoom in; so does Ctrl and the wheel", (a) => a.zoom(1.25)],
  ["-", "zoom out", (a) => a.zoom(0.8)],
  ["H", "show the whole design; Ctrl and a drag move the picture", (a) => a.home()],
  ["C", "save the last minute as CSV", (a) => a.csv()],
  ["P", "save the picture", (a) => a.png()],
  ["K", "save the design as a case file", (a) => a.save()],
  ["?", "this list", (a) => a.help()],
];

// Whether what is typed into an element stands in it.
const PLAIN = ["range", "checkbox", "file", "button"];
const typing = (e) =>
  (e.tagName === "INPUT" && !PLAIN.includes(e.type)) || e.tagName === "TEXTAREA" || e.isContentEditable;
// Whether an element does something of its own at a key: sliders and lists at arrows, boxes and buttons at Space.
function own(e, key) {
  if (e.tagName === "SELECT" || e.type === "range") return key.startsWith("Arrow") || key === " ";
  return (e.type === "checkbox" || e.tagName === "BUTTON") && (key === " " || key === "Enter");
}

export function bindKeys(actions, table, dialog) {
  table.replaceChildren(
    ...KEYS.map(([key, text, , shown]) => {
      const row = document.createElement("tr"),
        cell = document.createElement("td"),
        mark = document.createElement("kbd"),
        what = document.createElement("td");
      mark.textContent = shown ?? key;
      what.textContent = text;
      cell.append(mark);
      row.append(cell, what);
      return row;
    }),
  );
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || dialog.open) return;
    if (typing(event.target) || own(event.target, event.key)) return;
    const found = KEYS.find(([key]) => key.toLowerCase() === event.key.toLowerCase());
    if (!found) return;
    event.preventDefault();
    found[2](actions, event.shiftKey);
  });
}
