// Values under the pointer, and zoom along x, for the figures of this page. All values are read from the drawings.
(() => {
  "use strict";
  const number = (node, name) => Number(node.getAttribute(name));
  const make = (parent, tag, attributes) => {
    const node = document.createElementNS(parent.namespaceURI, tag);
    for (const name in attributes) node.setAttribute(name, attributes[name]);
    return parent.appendChild(node);
  };
  // what a part of a drawing and its sign in the legend have in common
  const look = (node) => {
    const of = (name) => node.getAttribute(name) || "none";
    if (of("fill") !== "none") return `${node.tagName === "circle" ? "dot" : of("stroke")} ${of("fill")}`;
    return `${0.1 > node.getBBox().width ? "bar" : of("stroke-dasharray")} ${of("stroke")}`;
  };
  const tidy = (value, span) => {
    const digits = 3 - Math.floor(Math.log10(span || 1));
    const text = digits > 7 ? value.toExponential(3) : value.toFixed(Math.max(0, digits));
    return text.replace(/\.0+$/, "").replace(/-/g, "\u2212");
  };
  const axis = (words) => {
    const [low, high, log] = words.split(" ").map(Number);
    const [a, b] = log ? [Math.log10(low), Math.log10(high)] : [low, high];
    // the digits that are worth showing follow from this span
    const span = (value, part) => (log ? Math.abs(value) : (high - low) * part);
    return { a, b, log, span, value: (share) => (log ? 10 ** (a + share * (b - a)) : a + share * (b - a)) };
  };
  const chart = (svg) => {
    const group = svg.querySelector("svg");
    const [left, top, width, height] = ["x", "y", "width", "height"].map((name) => number(group, name));
    const x = axis(svg.dataset.x), y = axis(svg.dataset.y), bottom = top + height;
    const labels = [...svg.querySelectorAll("text[font-size='13']")].map((node) => node.textContent);
    const unit = (/\((.*)\)$/.exec(labels[1] || "") || ["", ""])[1];
    const names = {}, series = new Map();
    for (const entry of svg.closest("figure").querySelectorAll(".legend li")) {
      const sign = entry.querySelector("path, circle, rect");
      if (sign) names[look(sign)] = entry.textContent;
    }
    const share = (at) => (at - left) / width, value = (at) => y.value((bottom - at) / height);
    const add = (label, at, low, high) => (series.get(label) || series.set(label, []).get(label)).push({ at: share(at), low: value(low), high: value(high) });
    const stretch = (node, from, to) => { node.setAttribute("x", from); node.setAttribute("width", to - from); };
    // how each part of the drawing moves; what values it has
    const moves = [...group.querySelectorAll("path, circle, rect")].map((node) => {
      const box = node.getBBox(), label = names[look(node)], path = node.getAttribute("d");
      const middle = box.x + box.width / 2, centre = box.y + box.height / 2;
      if (path && box.width > 14) {
        const numbers = /-?\d+(\.\d+)?/g, at = path.match(numbers).map(Number), all = at.length;
        const band = node.getAttribute("fill") !== "none"; // its upper edge, and back along the lower one
        for (let k = 0; label && (band ? all / 2 : all) > k; k += 2) add(label, at[k], at[band ? all - 1 - k : k + 1], at[k + 1]);
        return (place) => {
          let k = 0;
          node.setAttribute("d", path.replace(numbers, (text) => (k++ % 2 ? text : place(share(Number(text))).toFixed(2))));
        };
      }
      const bar = path && 0.1 > box.width, shade = !path && box.height > height - 2;
      if (label && !shade) add(label, middle, bar ? box.y + box.height : centre, bar ? box.y : centre);
      if (!shade) return (place) => node.setAttribute("transform", `translate(${(place(share(middle)) - middle).toFixed(2)})`);
      return (place) => stretch(node, place(share(box.x)), place(share(box.x + box.width)));
    });
    const ticks = svg.querySelector("g.x");
    const own = make(svg, "g", { "font-size": 12, "text-anchor": "middle", stroke: "none" });
    const box = make(svg, "rect", { y: top, height, fill: "#0072b2", "fill-opacity": 0.15 });
    const cursor = make(svg, "path", { stroke: "#57606a", fill: "none" });
    let view = [0, 1];
    const place = (at) => left + (width * (at - view[0])) / (view[1] - view[0]);
    const zoom = (to) => {
      view = to;
      moves.forEach((move) => move(place));
      const whole = view[0] === 0 && view[1] === 1, [low, high] = view.map((at) => x.a + at * (x.b - x.a));
      ticks.setAttribute("visibility", whole ? "visible" : "hidden");
      own.replaceChildren();
      const ten = 10 ** Math.floor(Math.log10((high - low) / 3));
      const step = ten * ([5, 2].find((of) => (high - low) / 3 >= of * ten) || 1);
      for (let at = Math.ceil(low / step) * step; !whole && high >= at; at += step) {
        const across = place((at - x.a) / (x.b - x.a));
        make(own, "path", { d: `M${across} ${bottom}v5`, stroke: "#424a53" });
        const text = x.log ? (10 ** at).toPrecision(2) : at.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
        make(own, "text", { x: across, y: bottom + 16 }).textContent = text.replace("-", "\u2212");
      }
    };
    // the sample nearest to a share of the axis, with those of the other series beside it
    const read = (wanted) => {
      const nearest = (points, to) => points.reduce((best, of) => (Math.abs(of.at - to) >= Math.abs(best.at - to) ? best : of));
      const seen = [...series.values()].flat().filter(({ at }) => at >= view[0] - 1e-9 && view[1] + 1e-9 >= at);
      if (!seen.length) return null;
      const { at } = nearest(seen, wanted), here = x.value(at), part = view[1] - view[0];
      const named = svg.dataset.names && document.querySelectorAll(`#${svg.dataset.names} ~ .scroll tbody th`)[Math.round(here) - 1];
      const lines = [named ? named.textContent : `${labels[0] || ""}: ${tidy(here, x.span(here, part))}`];
      for (const [label, points] of series) {
        const point = nearest(points, at);
        if (Math.abs(point.at - at) > 0.02 * part) continue;
        const [low, high] = [point.low, point.high].map((of) => tidy(of, y.span(of, 1))), to = low === high ? low : `${low} to ${high}`;
        lines.push(label.startsWith("outside") ? label : `${label}: ${to} ${unit}`); // a mark at the edge of the axis is not at its value
      }
      cursor.setAttribute("d", `M${place(at)} ${top}V${bottom}`);
      return { at, lines, across: place(at) };
    };
    const mark = (from, to) => stretch(box, place(Math.min(from, to)), place(Math.max(from, to)));
    const at = (event) => {
      const { left: start, width: shown } = svg.getBoundingClientRect();
      const across = Math.max(0, Math.min(1, share(((event.clientX - start) * svg.viewBox.baseVal.width) / shown)));
      return view[0] + across * (view[1] - view[0]);
    };
    // as the files of --figures, with the digits that a drawing has
    const digits = (of) => String(Number(of.toPrecision(6)));
    const rows = () => [...series].flatMap(([label, points]) => points.map(({ at: of, low, high }) => [svg.getAttribute("aria-label"), labels[0] || "", labels[1] || "", label, ...[x.value(of), (low + high) / 2, (high - low) / 2].map(digits)]));
    return { zoom, read, mark, at, x, rows, label: labels[0], view: () => view, hide: () => cursor.removeAttribute("d") };
  };
  const tip = document.body.appendChild(document.createElement("div"));
  Object.assign(tip, { className: "tip", role: "status", hidden: true });
  for (const svg of document.querySelectorAll("svg[data-x]")) {
    let start = null, last = svg.tabIndex = 0;
    const own = () => (svg.chart = svg.chart || chart(svg));
    svg.rows = () => own().rows();
    // panels of a figure with the same quantity along x are zoomed together
    const zoom = (view) => {
      const { x, label } = own(), whole = view[0] === 0 && view[1] === 1;
      const charts = [...svg.parentNode.querySelectorAll("svg[data-x]")].map((other) => (other.chart = other.chart || chart(other)));
      for (const one of charts.filter((other) => other.label === label && !other.x.log === !x.log)) {
        one.zoom(whole ? view : view.map((at) => (x.a + at * (x.b - x.a) - one.x.a) / (one.x.b - one.x.a)));
      }
    };
    const hide = () => { tip.hidden = true; own().hide(); own().mark(0, 0); start = null; };
    const show = (wanted) => {
      const found = own().read(wanted), frame = svg.getBoundingClientRect();
      tip.hidden = !found;
      if (!found) return;
      tip.textContent = found.lines.join("\n");
      const across = frame.left + (found.across * frame.width) / svg.viewBox.baseVal.width + 12;
      tip.style.left = `${Math.max(4, Math.min(across, document.body.clientWidth - tip.offsetWidth - 4)) + scrollX}px`;
      tip.style.top = `${frame.top + scrollY - tip.offsetHeight}px`;
      last = found.at;
    };
    const on = (name, act) => svg.addEventListener(name, act);
    on("pointerdown", (event) => { start = own().at(event); svg.setPointerCapture(event.pointerId); show(start); });
    on("pointermove", (event) => { if (start !== null) own().mark(start, own().at(event)); show(own().at(event)); });
    on("pointerup", (event) => {
      const [low, high] = [start, own().at(event)].sort((a, b) => a - b), [from, to] = own().view();
      if (start !== null && high - low > Math.max(0.03 * (to - from), 1e-4)) zoom([low, high]);
      own().mark(0, (start = null));
    });
    for (const name of ["pointercancel", "pointerleave", "blur"]) on(name, hide);
    on("dblclick", () => zoom([0, 1]));
    on("keydown", (event) => {
      const [low, high] = own().view(), middle = last > low && high >= last ? last : (low + high) / 2;
      const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key], near = (high - low) / 4;
      if (step) show(Math.max(low, Math.min(high, middle + step * (high - low))));
      else if (event.key === "+") zoom([Math.max(0, middle - near), Math.min(1, middle + near)]);
      else if (event.key === "Escape") { zoom([0, 1]); hide(); } else return;
      event.preventDefault();
    });
  }
})();
