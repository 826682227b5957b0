// Draws the figures of the page; the data stands in the page as JSON.
(function () {
  "use strict";
  var figures = JSON.parse(document.getElementById("figures").textContent);
  var options = { displayModeBar: false, responsive: true, showTips: false };
  Object.keys(figures).forEach(function (id) {
    Plotly.newPlot(id, figures[id].data, figures[id].layout, options);
  });
  window.addEventListener("beforeprint", function () {
    document.querySelectorAll("details").forEach(function (part) { part.open = true; });
    Object.keys(figures).forEach(function (id) { Plotly.Plots.resize(id); });
  });
  document.documentElement.setAttribute("data-drawn", Object.keys(figures).length);
})();
