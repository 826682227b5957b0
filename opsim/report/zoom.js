// Figures whose x-axis may move: buttons below them, so that keyboard and touch do it too; a mouse drags, and zooms
// with ctrl and its wheel. The buttons are there when the figure is drawn.
var zoomable = (function () {
  "use strict";
  var MOVES = [
    ["\u25c0 earlier", -0.5, 1], ["later \u25b6", 0.5, 1], ["closer", 0, 0.5], ["wider", 0, 2], ["all", 0, 0]
  ];

  function number(value) {
    if (typeof value === "number") return value;
    return new Date(value.replace(" ", "T") + (value.length > 10 ? "Z" : "")).getTime();
  }

  function move(plot, whole, along, factor) {
    var now = plot.layout.xaxis.range.map(number), width = now[1] - now[0];
    var wide = factor ? Math.min(width * factor, whole[1] - whole[0]) : whole[1] - whole[0];
    var middle = (now[0] + now[1]) / 2 + along * width;
    var low = Math.max(whole[0], Math.min(middle - wide / 2, whole[1] - wide));
    Plotly.relayout(plot, { "xaxis.range": [low, low + wide] });
  }

  return function (plot, layout) {
    var axis = layout.xaxis;
    if (!axis || axis.fixedrange !== false) return;
    var whole = (axis.minallowed === undefined ? axis.range : [axis.minallowed, axis.maxallowed]).map(number);
    var bar = document.createElement("div");
    bar.className = "zoom";
    bar.setAttribute("role", "group");
    bar.setAttribute("aria-label", "move the clock of this figure");
    MOVES.forEach(function (one) {
      var button = document.createElement("button");
      button.type = "button";
      button.textContent = one[0];
      button.addEventListener("click", function () { move(plot, whole, one[1], one[2]); });
      bar.appendChild(button);
    });
    plot.insertAdjacentElement("afterend", bar);
    if (window.matchMedia("(pointer: fine)").matches) Plotly.relayout(plot, { dragmode: "pan" });
    plot.addEventListener("wheel", function (event) {
      if (!event.ctrlKey) return;
      event.preventDefault();
      move(plot, whole, 0, event.deltaY > 0 ? 1.25 : 0.8);
    }, { passive: false });
  };
})();
