// Draws the figures of the page, whose data stands in it as JSON: those in sight at once, the others while nobody
// waits or as they come into sight; those folded away as they are opened; all before the page is printed.
(function () {
  "use strict";
  var figures = JSON.parse(document.getElementById("figures").textContent);
  var options = { displayModeBar: false, responsive: true, showTips: false };
  var waiting = Object.keys(figures);
  var opened = [];
  var root = document.documentElement;

  function isIn(element, margin) {
    var box = element.getBoundingClientRect();
    return !element.closest("details:not([open])") && box.top < window.innerHeight + margin && box.bottom > -margin;
  }

  function draw(id) {
    waiting.splice(waiting.indexOf(id), 1);
    seen.unobserve(document.getElementById(id));
    Plotly.newPlot(id, figures[id].data, figures[id].layout, options);
    zoomable(document.getElementById(id), figures[id].layout);
  }

  function drawNext() {
    var next = waiting.find(function (id) { return !document.getElementById(id).closest("details:not([open])"); });
    if (next === undefined) {
      root.setAttribute("data-all-drawn", Object.keys(figures).length - waiting.length);
      return;
    }
    draw(next);
    later(drawNext);
  }

  function later(work) {
    if (window.requestIdleCallback) window.requestIdleCallback(work, { timeout: 200 });
    else window.setTimeout(work, 20);
  }

  var seen = new IntersectionObserver(function (entries) {
    entries.forEach(function (entry) {
      if (entry.isIntersecting && waiting.includes(entry.target.id)) draw(entry.target.id);
    });
  }, { rootMargin: "600px" });

  waiting.slice().forEach(function (id) {
    var element = document.getElementById(id);
    if (isIn(element, 200)) draw(id);
    else seen.observe(element);
  });

  window.addEventListener("beforeprint", function () {
    document.querySelectorAll("details:not([open])").forEach(function (part) {
      if (part.closest(".not-on-paper:not([open])")) return;
      part.open = true;
      opened.push(part);
    });
    waiting.slice().forEach(draw);
    Object.keys(figures).forEach(function (id) { Plotly.Plots.resize(id); });
  });
  window.addEventListener("afterprint", function () {
    opened.splice(0).forEach(function (part) { part.open = false; });
  });
  root.setAttribute("data-drawn", Object.keys(figures).length - waiting.length);
  later(drawNext);
})();
