const all = [...document.querySelectorAll("button, select, input:not([type=file])")];
all.filter((e) => e.offsetParent).map((e) => {
  const { width, height } = e.getBoundingClientRect();
  return [e.type, e.id || e.ariaLabel, Math.min(width, height), width];
})
