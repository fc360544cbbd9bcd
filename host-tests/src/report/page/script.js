"use strict";
// Values of a figure under the pointer: the point of each series that lies nearest along the horizontal axis.
for (const area of document.querySelectorAll(".area")) {
  const source = area.closest("figure").querySelector("script");
  let data;
  const read = () => data ||= JSON.parse(source.textContent);
  const place = (axis, value) => {
    const at = axis.logarithmic ? Math.log10(value) : value;
    return (at - axis.low) / (axis.high - axis.low);
  };
  const inside = (part) => part >= -0.001 && part <= 1.001;
  const is_map = area.closest(".map") !== null;
  const within = (value, axis) => axis.circle ? ((value % 360) + 360) % 360 : value;
  const shown = (value, axis) =>
    `${Number(within(value, axis).toPrecision(6))}${axis.unit ? " " + axis.unit : ""}`;
  const limits = ([, , low, high], axis) =>
    low === undefined ? "" : ` (${shown(low, { ...axis, unit: "" })} … ${shown(high, axis)})`;
  const cross = document.createElement("div");
  const tip = document.createElement("div");
  cross.className = "cross";
  tip.className = "tip";

  // Of the points of a series that can be seen, the nearest one, and how far it is.
  const nearest = (series, px, py, box) => {
    let best = null;
    for (const point of series.points) {
      const [x, y] = [place(data.x, point[0]), place(data.y, point[1])];
      if (!inside(x) || (!series.style.endsWith("band") && !inside(y))) continue;
      const along = (x - px) * box.width;
      const off = is_map ? Math.hypot(along, (1 - y - py) * box.height) : Math.abs(along);
      if (best === null || best.off > off) best = { series, point, x, off };
    }
    return best;
  };
  const line = (found) => {
    const row = document.createElement("div");
    const dot = document.createElement("i");
    const words = document.createElement("span");
    row.className = found.series.class;
    const value = found.series.style.endsWith("band") ? "" : `: ${shown(found.point[1], data.y)}`;
    words.textContent = found.series.name + value + limits(found.point, data.y);
    row.append(dot, words);
    return row;
  };
  const show = (event) => {
    read();
    const box = area.getBoundingClientRect();
    const [px, py] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    let found = data.series.map((series) => nearest(series, px, py, box)).filter((best) => best !== null);
    if (found.length === 0) return;
    const first = found.reduce((a, b) => (b.off >= a.off ? a : b));
    // What has no point near this place is not shown with it.
    found = found.filter((best) => Math.abs(best.x - first.x) * box.width <= 12 && (!is_map || best === first));
    cross.style.left = `${100 * first.x}%`;
    const head = document.createElement("div");
    head.textContent = `${data.x.label}: ${shown(first.point[0], data.x)}`;
    tip.replaceChildren(head, ...found.map(line));
    tip.style.left = first.x > 0.5 ? "auto" : `calc(${100 * first.x}% + .6rem)`;
    tip.style.right = first.x > 0.5 ? `calc(${100 * (1 - first.x)}% + .6rem)` : "auto";
    area.append(cross, tip);
  };
  const hide = () => { cross.remove(); tip.remove(); };
  area.addEventListener("pointermove", show);
  area.addEventListener("pointerdown", show);
  // What a finger touched stays until it touches something else.
  area.addEventListener("pointerleave", (event) => { if (event.pointerType === "mouse") hide(); });
  addEventListener("pointerdown", (event) => { if (!area.contains(event.target)) hide(); });
}
// The words of a stretch of time where there is no pointer that could rest on it.
for (const timeline of document.querySelectorAll(".timeline")) {
  const readout = timeline.querySelector(".readout");
  const show = (event) => { readout.textContent = event.target.title || ""; };
  timeline.addEventListener("pointerover", show);
  timeline.addEventListener("pointerdown", show);
}
// Paper cannot be unfolded.
addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
});
