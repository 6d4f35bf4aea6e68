(parts => parts.forEach((name, k) => {
  const box = document.querySelector(name).getBoundingClientRect(), mark = document.createElement("b");
  mark.textContent = k + 1;
  mark.style.cssText = `position: fixed; left: ${Math.max(0, box.left - 17)}px; top: ${box.top + 2}px;
    width: 17px; background: #c2371a; color: #fff; font: bold 12px/17px sans-serif; text-align: center;
    z-index: 9`;
  document.body.append(mark);
}))
