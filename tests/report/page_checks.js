"use strict";
// Looks at a report in an iframe from outside; writes a line that begins with NOT for whatever is
// wrong. The wanted colour scheme is the fragment of the address.
const lines = [];
const expect = (condition, what) => {
  if (!condition) lines.push("NOT " + what);
};
const dark = location.hash === "#dark";

function luminance(color) {
  const [r, g, b] = color.match(/[\d.]+/g).map((c) => {
    const v = Number(c) / 255;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function check(doc, view) {
  const all = (selector) => Array.from(doc.querySelectorAll(selector));
  const root = doc.documentElement;
  expect(root.dataset.report === "ready", "ready: the page's script did not end");
  expect(root.scrollWidth <= view.innerWidth,
    `within the page: ${root.scrollWidth} of ${view.innerWidth} px`);
  expect(view.performance.getEntriesByType("resource").every((e) => e.name.startsWith("data:")),
    "self-contained");

  const style = view.getComputedStyle(doc.body);
  const paper = luminance(style.backgroundColor);
  const ink = luminance(style.color);
  expect(dark ? paper < 0.1 : paper > 0.8, "in the wanted colours");
  const contrast = (Math.max(paper, ink) + 0.05) / (Math.min(paper, ink) + 0.05);
  expect(contrast > 7, "legible: contrast " + contrast);

  const methods = all(".legend button").length;
  const plots = all(".plot");
  expect(plots.length === 4, "four plots: " + plots.length);
  for (const plot of plots) {
    const drawn = plot.querySelectorAll("polyline");
    expect(drawn.length === methods, "a line a method: " + drawn.length);
    for (const line of drawn) {
      const box = line.getBoundingClientRect();
      expect(box.width > 200 && line.getTotalLength() > 100, "drawn: " + box.width + " px");
      expect(view.getComputedStyle(line).stroke !== "none", "visible");
    }
    const ticks = Array.from(plot.querySelectorAll(".tick.x")).map((t) => t.getBoundingClientRect());
    for (let i = 1; i < ticks.length; ++i) {
      expect(ticks[i].left > ticks[i - 1].right, "labels apart");
    }
    expect(plot.querySelectorAll(".tick.y").length > 2, "labelled");
    for (const tick of plot.querySelectorAll(".tick")) {
      expect(parseFloat(view.getComputedStyle(tick).fontSize) >= 11.5, "labels large enough");
    }
  }

  // The cursor follows the pointer, in all plots at once.
  const box = plots[0].querySelector(".plot-box");
  const area = box.getBoundingClientRect();
  const readouts = () => all(".readout b").map((value) => value.textContent).join();
  const point = (x) => box.dispatchEvent(new view.PointerEvent("pointermove", { clientX: x }));
  point(area.left + 1);
  const first = readouts();
  point(area.right - 1);
  expect(first !== readouts(), "a readout that follows the pointer");
  const slider = doc.querySelector(".scrub input");
  expect(slider.value === slider.max, "a slider that follows the pointer");
  slider.value = "0";
  slider.dispatchEvent(new view.Event("input"));
  expect(readouts() === first, "a readout that follows the slider");

  // Lines can be hidden.
  const button = doc.querySelector(".legend button");
  const line = plots[0].querySelector('polyline[data-method="0"]');
  button.click();
  expect(view.getComputedStyle(line).display === "none", "a line that can be hidden");
  expect(button.getAttribute("aria-pressed") === "false", "a button that says so");
  button.click();
  expect(view.getComputedStyle(line).display !== "none", "a line that comes back");

  // Pictures are there and can be enlarged.
  const pictures = all(".picture img");
  expect(pictures.length >= 2, "pictures");
  for (const picture of pictures) {
    expect(picture.complete && picture.naturalWidth > 100 && picture.alt !== "", "a picture");
  }
  const dialog = doc.querySelector("dialog");
  pictures[0].click();
  expect(dialog.open, "a picture that can be enlarged");
  dialog.querySelector("form button:last-child").click();
  expect(!dialog.open, "a picture that can be closed");

  // Every value of the table is a number or unknown.
  for (const cell of all("table td")) expect(!/nan|inf/i.test(cell.textContent), "numbers");
  expect(doc.body.textContent.includes("undefined") === false, "defined values");
}

document.getElementById("report").addEventListener("load", (event) => {
  try {
    check(event.target.contentDocument, event.target.contentWindow);
    lines.push("ALL CHECKS DONE");
  } catch (error) {
    lines.push("NOT checked to the end: " + error.message);
  }
  document.getElementById("result").textContent = "\n" + lines.join("\n") + "\n";
});
