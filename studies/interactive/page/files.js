// What leaves the page and what comes in: CSV, pictures, links and session files. Nothing is sent anywhere else.
export function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  window.studio.saved = { name, size: content.size ?? content.length, text: typeof content === "string" ? content : null };
}

const COLUMNS = [
  ["time_s", (s) => s.t], ["mode", (s) => s.mode], ["simulated_s", (s) => s.simulated],
  ["x_m", (s) => s.pose[0]], ["y_m", (s) => s.pose[1]], ["rotation_rad", (s) => s.pose[2]],
  ["force_x_N", (s) => s.force[0]], ["force_y_N", (s) => s.force[1]], ["moment_Nm", (s) => s.force[2]],
  ["stiffness_Nm_per_rad", (s) => s.stiffness], ["stress_max_Pa", (s) => s.stress.max],
  ["strain_energy_J", (s) => s.energy.strain], ["kinetic_energy_J", (s) => s.energy.kinetic], ["dissipated_J", (s) => s.energy.dissipated],
  ["lost_to_steps_J", (s) => s.energy.lost],
  ["centre_x_m", (s) => s.centre?.[0]], ["centre_y_m", (s) => s.centre?.[1]],
  ["sd_x_m", (s) => s.sd?.[0]], ["sd_y_m", (s) => s.sd?.[1]], ["sd_rotation_rad", (s) => s.sd?.[2]], ["solve_ms", (s) => s.solve_ms],
];

export function csv(states) {
  const rows = states.map((s) => COLUMNS.map(([, value]) => value(s) ?? "").join(","));
  return [COLUMNS.map(([name]) => name).join(","), ...rows, ""].join("\n");
}

export async function copyLink(state) {
  const design = JSON.stringify({ preset: state.preset, values: state.values });
  const link = `${location.origin}/#design=${encodeURIComponent(btoa(design))}`;
  history.replaceState(null, "", link);
  try { await navigator.clipboard.writeText(link); return "Link copied: it holds the whole design."; } catch { return "The address now holds the whole design."; }
}

export function designOf(hash) {
  const found = /(?:^#|&)design=([^&]+)/.exec(hash);
  if (!found) return null;
  try { return JSON.parse(atob(decodeURIComponent(found[1]))); } catch { return null; }
}

// A session file: its events again, at their times.
export async function play(text, send, say, studio) {
  const events = [];
  for (const line of text.split("\n")) if (line.trim()) try { events.push(JSON.parse(line)); } catch { return say("This is no session file."); }
  if (events[0]?.do !== "setup") return say("This is no session file.");
  studio.replaying = true;
  const begin = performance.now(), first = events[1]?.t ?? 0;
  for (const { t, mark, ...event } of events) {
    const wait = ((t ?? first) - first) * 1000 - (performance.now() - begin);
    if (wait > 0) await new Promise((done) => setTimeout(done, wait));
    send(event);
  }
  studio.replaying = false;
  say("The session file has ended.");
}
