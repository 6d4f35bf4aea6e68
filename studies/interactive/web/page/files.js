// What leaves the page and what comes in: CSV, pictures and designs. Nothing is sent anywhere else.
export function save(name, content, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  window.studio.saved = {
    name,
    size: content.size ?? content.length,
    text: typeof content === "string" ? content : null,
  };
}

const COLUMNS = [
  ["time_s", (s) => s.t],
  ["mode", (s) => s.mode],
  ["simulated_s", (s) => s.simulated],
  ["x_m", (s) => s.pose[0]],
  ["y_m", (s) => s.pose[1]],
  ["rotation_rad", (s) => s.pose[2]],
  ["force_x_N", (s) => s.force[0]],
  ["force_y_N", (s) => s.force[1]],
  ["moment_Nm", (s) => s.force[2]],
  ["stiffness_Nm_per_rad", (s) => s.stiffness],
  ["stress_max_Pa", (s) => s.stress.max],
  ["strain_energy_J", (s) => s.energy.strain],
  ["kinetic_energy_J", (s) => s.energy.kinetic],
  ["potential_of_load_J", (s) => s.energy.potential],
  ["dissipated_J", (s) => s.energy.dissipated],
  ["centre_x_m", (s) => s.centre?.[0]],
  ["centre_y_m", (s) => s.centre?.[1]],
  ["sd_x_m", (s) => s.sd?.[0]],
  ["sd_y_m", (s) => s.sd?.[1]],
  ["sd_rotation_rad", (s) => s.sd?.[2]],
  ["solve_ms", (s) => s.solve_ms],
];

export function csv(states) {
  const rows = states.map((s) => COLUMNS.map(([, value]) => value(s) ?? "").join(","));
  return [COLUMNS.map(([name]) => name).join(","), ...rows, ""].join("\n");
}

// What a page that is loaded again goes on with.
export const keep = (state) =>
  sessionStorage.setItem(
    "design",
    JSON.stringify({
      preset: state.preset,
      values: state.values,
      case: window.studio.curve?.case ?? undefined,
      drive: state.drive,
      pose: state.displacement,
    }),
  );
export function kept() {
  try {
    return JSON.parse(sessionStorage.getItem("design"));
  } catch {
    return null;
  }
}

// A case file goes up as one message, whose first bytes are its kind and version.
export async function upload(file, send) {
  send(new Uint8Array([3, 1, ...new Uint8Array(await file.arrayBuffer())]));
}
