"use strict";
// Everything here adds to a page that is complete without it: a cursor through the frames, lines
// that can be hidden, pictures that can be enlarged.
(() => {
  const root = document.documentElement;
  const data = JSON.parse(document.getElementById("data").textContent);
  const all = (selector, within) => Array.from((within || document).querySelectorAll(selector));
  root.classList.add("js");
  const hidden = data.methods.map(() => false);
  const slider = document.querySelector(".scrub input");
  const frameOutput = document.querySelector(".scrub output");

  const plots = all(".plot").map((figure) => {
    const box = figure.querySelector(".plot-box");
    const plot = Object.assign({ figure, box }, data.plots[Number(figure.dataset.plot)]);
    plot.cursor = box.appendChild(document.createElement("div"));
    plot.cursor.className = "cursor";
    plot.dots = data.methods.map((method) => {
      const dot = box.appendChild(document.createElement("div"));
      dot.className = "dot " + method.style;
      return dot;
    });
    const readout = figure.appendChild(document.createElement("ul"));
    readout.className = "readout";
    plot.values = data.methods.map((method) => {
      const item = readout.appendChild(document.createElement("li"));
      item.append(method.name + " ");
      return item.appendChild(document.createElement("b"));
    });
    return plot;
  });

  function show(index) {
    const count = data.frames.length;
    const x = count > 1 ? (100 * index) / (count - 1) : 50;
    for (const plot of plots) {
      plot.cursor.style.left = x + "%";
      plot.lines.forEach((line, m) => {
        const value = line[index];
        const known = value !== null;
        const place = known ? (100 * (value - plot.low)) / (plot.high - plot.low) : 0;
        plot.dots[m].hidden = !known || hidden[m];
        plot.dots[m].style.left = x + "%";
        plot.dots[m].style.bottom = place + "%";
        plot.dots[m].style.marginTop = "0";
        plot.values[m].textContent = known ? value.toFixed(plot.decimals) : "–";
        plot.values[m].parentNode.hidden = hidden[m];
      });
    }
    if (slider) {
      slider.value = String(index);
      frameOutput.textContent = "frame " + data.frames[index];
    }
  }

  let current = Math.floor(data.frames.length / 2);
  const go = (index) => {
    current = Math.max(0, Math.min(data.frames.length - 1, index));
    show(current);
  };
  if (slider) slider.addEventListener("input", () => go(Number(slider.value)));
  for (const plot of plots) {
    const follow = (event) => {
      const area = plot.box.getBoundingClientRect();
      if (area.width > 0) {
        go(Math.round(((event.clientX - area.left) / area.width) * (data.frames.length - 1)));
      }
    };
    plot.box.addEventListener("pointermove", follow);
    plot.box.addEventListener("pointerdown", follow);
  }

  for (const button of all(".legend button")) {
    button.addEventListener("click", () => {
      const m = Number(button.dataset.method);
      hidden[m] = !hidden[m];
      button.setAttribute("aria-pressed", String(!hidden[m]));
      for (const line of all(`.line[data-method="${m}"]`)) {
        line.style.display = hidden[m] ? "none" : "";
      }
      show(current);
    });
  }

  const dialog = document.querySelector("dialog");
  const pictures = all(".picture img");
  if (dialog && dialog.showModal) {
    const image = dialog.querySelector("img");
    const caption = dialog.querySelector("output");
    let at = 0;
    const enlarge = (index) => {
      at = (index + pictures.length) % pictures.length;
      image.src = pictures[at].src;
      image.alt = pictures[at].alt;
      caption.textContent = pictures[at].alt;
    };
    pictures.forEach((picture, index) => {
      picture.tabIndex = 0;
      const open = () => {
        enlarge(index);
        dialog.showModal();
      };
      picture.addEventListener("click", open);
      picture.addEventListener("keydown", (event) => {
        if (event.key === "Enter") open();
      });
    });
    dialog.addEventListener("keydown", (event) => {
      if (event.key === "ArrowRight") enlarge(at + 1);
      if (event.key === "ArrowLeft") enlarge(at - 1);
    });
    image.addEventListener("click", () => dialog.close());
    for (const button of all("button[data-step]", dialog)) {
      button.addEventListener("click", () => enlarge(at + Number(button.dataset.step)));
    }
  }

  if (plots.length > 0) show(current);
  root.dataset.report = "ready";
})();
