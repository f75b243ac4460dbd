for (const figure of document.querySelectorAll("figure.player")) {
  const data = figure.dataset, svg = figure.querySelector(".stage svg");
  const numbers = text => text.split(",").map(Number);
  const points = text => {
    const flat = numbers(text), list = [];
    for (let k = 0; k + 2 < flat.length; k += 3) list.push(flat.slice(k, k + 3));
    return list;
  };
  const frames = data.frames.split(";").map(points);
  const runs = text => text ? text.split(";").map(points) : [];
  const path = runs(data.path), floor = runs(data.floor), obstacles = runs(data.obstacles);
  const capsules = 2 * Number(data.capsules);
  const names = points(data.names), scale = Number(data.scale), [start, end] = numbers(data.times);
  const { width, height } = svg.viewBox.baseVal;
  let [azimuth, elevation] = numbers(data.view), place = 0, playing = false, before = 0;

  const part = name => svg.querySelector(`[data-part=${name}]`);
  const set = (name, d) => part(name)?.setAttribute("d", d);
  const button = figure.querySelector("[data-do=play]"), slider = figure.querySelector("input");
  const output = figure.querySelector("output");

  /* a posture between two frames */
  const posture = () => {
    const at = place * (frames.length - 1), first = Math.min(Math.floor(at), frames.length - 2), u = at - first;
    return frames[first].map((point, k) => point.map((x, j) => x + u * (frames[first + 1][k][j] - x)));
  };

  const draw = () => {
    const a = azimuth * Math.PI / 180, e = elevation * Math.PI / 180;
    const [sa, ca, se, ce] = [Math.sin(a), Math.cos(a), Math.sin(e), Math.cos(e)];
    const at = ([x, y, z]) => [
      (width / 2 + scale * (ca * y - sa * x)).toFixed(1),
      (height / 2 - scale * (ce * z - se * (ca * x + sa * y))).toFixed(1),
    ];
    const line = list => "M" + list.map(point => at(point).join(" ")).join("L");
    const dots = list => list.map(point => `M${at(point).join(" ")}h.01`).join("");
    const now = posture(), shapes = now.splice(now.length - capsules, capsules);
    const links = now.slice(0, -4), tip = links[links.length - 1], ends = now.slice(-4);
    set("floor", floor.map(line).join(""));
    set("obstacles", obstacles.map(line).join(""));
    for (let k = 0; k < shapes.length; k += 2) set(`capsule${k / 2}`, line(shapes.slice(k, k + 2)));
    set("path", path.map(line).join(""));
    set("links", line(links));
    set("joints", dots(links));
    set("base", dots(links.slice(0, 1)));
    for (let k = 0; k < 3; k++) {
      set(`axis${k}`, line([tip, ends[k]]));
      const [x, y] = at(names[k]);
      part(`name${k}`).setAttribute("x", x);
      part(`name${k}`).setAttribute("y", y);
    }
    set("lever", line([tip, ends[3]]));
    set("sensor", dots([ends[3]]));
    const time = `${(start + place * (end - start)).toFixed(1)} s`;
    output.textContent = time;
    svg.setAttribute("aria-label", `The machine at ${time}`);
    slider.value = place;
  };

  const step = now => {
    if (!playing) return;
    place += Math.max(0, now - before) / 1000 / Math.max(end - start, 1e-3);
    if (place >= 1) place = 0;
    before = now;
    draw();
    requestAnimationFrame(step);
  };
  const play = on => {
    playing = on;
    button.textContent = on ? "Pause" : "Play";
    before = performance.now();
    if (on) requestAnimationFrame(step);
  };
  const turn = (by, up) => {
    azimuth -= by;
    elevation = Math.max(-90, Math.min(90, elevation + up));
    draw();
  };

  button.addEventListener("click", () => play(!playing));
  slider.addEventListener("input", () => {
    play(false);
    place = Number(slider.value);
    draw();
  });
  for (const choice of figure.querySelectorAll("[data-view]")) {
    choice.addEventListener("click", () => {
      [azimuth, elevation] = numbers(choice.dataset.view);
      draw();
    });
  }
  svg.addEventListener("pointerdown", event => svg.setPointerCapture(event.pointerId));
  svg.addEventListener("pointermove", event => {
    if (svg.hasPointerCapture(event.pointerId)) turn(0.5 * event.movementX, 0.5 * event.movementY);
  });
  svg.addEventListener("keydown", event => {
    const by = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
    if (!by) return;
    turn(...by);
    event.preventDefault();
  });
  figure.querySelector(".controls").hidden = false;
  draw();
}
