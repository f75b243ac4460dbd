// Files of the figures of this page: a drawing, and the values in it, which chart.js reads.
(() => {
  "use strict";
  const namespace = (document.querySelector("svg") || document.body).namespaceURI;
  const set = (node, attributes) => { for (const name in attributes) node.setAttribute(name, attributes[name]); };
  const make = (parent, tag, attributes) => {
    const node = document.createElementNS(namespace, tag);
    set(node, attributes);
    return parent ? parent.appendChild(node) : node;
  };
  // a figure as one drawing: title, panels in rows, legend
  const drawing = (figure) => {
    const svgs = [...figure.querySelectorAll("svg")].filter((svg) => !svg.parentNode.closest("svg, .legend"));
    const name = figure.querySelector("h3") ? figure.querySelector("h3").textContent : document.title;
    const wide = Math.max(...svgs.map((svg) => svg.viewBox.baseVal.width)), columns = Math.min(svgs.length, figure.querySelector(".one") ? 1 : figure.querySelector(".two") ? 2 : 3);
    const root = make(null, "svg", { "font-family": svgs[0].getAttribute("font-family"), fill: "#1b1f24" });
    make(root, "rect", { width: "100%", height: "100%", fill: "#fff" });
    make(root, "text", { x: 20, y: 22, "font-size": 17 }).textContent = name;
    let top = 34, high = 0;
    svgs.forEach((svg, k) => {
      if (k % columns === 0) [top, high] = [top + high, 0];
      const { width, height } = svg.viewBox.baseVal, copy = root.appendChild(svg.cloneNode(true));
      set(copy, { x: (k % columns) * wide, y: top, width, height });
      high = Math.max(high, height);
    });
    top += high;
    figure.querySelectorAll(".legend li").forEach((entry) => {
      const copy = entry.querySelector("svg") && root.appendChild(entry.querySelector("svg").cloneNode(true));
      top += 20;
      if (copy) set(copy, { x: 20, y: top - 12, width: 34, height: 14 });
      make(root, "text", { x: 62, y: top, "font-size": 13 }).textContent = entry.textContent;
    });
    const size = [columns * wide, top + 14];
    set(root, { width: size[0], height: size[1], viewBox: `0 0 ${size.join(" ")}` });
    return new XMLSerializer().serializeToString(root);
  };
  const csv = (rows) => rows.map((row) => row.map((text) => (/[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text)).join(",") + "\n").join("");
  const values = (figure) => {
    const titled = (cell) => [...cell.querySelectorAll("[title]")].map((part) => part.title).join("; ");
    const panels = [...figure.querySelectorAll("svg[data-x]")].flatMap((svg) => svg.rows());
    if (panels.length) return csv([["panel", "x_label", "y_label", "series", "x", "y", "half_width"], ...panels]);
    return csv([...figure.querySelectorAll("tr")].map((row) => [...row.cells].map((cell) => titled(cell) || cell.textContent)));
  };
  for (const figure of document.querySelectorAll("figure")) {
    const bar = Object.assign(document.createElement("div"), { className: "save screen" });
    const add = (kind, type, make) => {
      const button = bar.appendChild(Object.assign(document.createElement("button"), { textContent: `Save ${kind.toUpperCase()}` }));
      button.addEventListener("click", () => {
        const name = `${document.title} ${figure.querySelector("h3") ? figure.querySelector("h3").textContent : ""}`.replace(/[^\p{L}\p{N}]+/gu, "-");
        const link = Object.assign(document.createElement("a"), { download: `${name}.${kind}`, href: URL.createObjectURL(new Blob([make(figure)], { type })) });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
      });
    };
    const has = (what) => figure.querySelector(what);
    if (has("svg:not(.legend svg)")) add("svg", "image/svg+xml", drawing);
    if (has("svg[data-x]") || has("table")) add("csv", "text/csv", values);
    if (bar.childNodes.length) figure.append(bar);
  }
})();
