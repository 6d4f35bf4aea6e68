(() => { const s = studio.state, box = studio.view.canvas.getBoundingClientRect();
  const [u, v] = studio.view.to(s.pose[0], s.pose[1]);
  const [width, height] = studio.view.size;
  return [box.left + u / width * box.width, box.top + v / height * box.height]; })()
