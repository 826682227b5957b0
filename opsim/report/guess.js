// Keeps the reader's guesses on who is real, and tells on request. The answers are packed: no glance gives them away.
(function () {
  "use strict";
  var answers = JSON.parse(atob(JSON.parse(document.getElementById("film").textContent).answers));
  var figures = Array.prototype.slice.call(document.querySelectorAll(".card"));
  var guesses = answers.map(function () { return null; }), revealed = false;
  function $(id) { return document.getElementById(id); }

  function mark(i, value) {
    guesses[i] = guesses[i] === value ? null : value;
    show();
  }
  function choose(n, k) { for (var out = 1, i = 1; i <= k; i++) out = out * (n - k + i) / i; return k < 0 || k > n ? 0 : out; }
  // Somebody who deals out as many "real" at random: how often he finds as many or more.
  function luck(found, said) {
    var n = answers.length, real = answers.filter(function (a) { return a[0]; }).length, as_good = 0, hit;
    for (hit = 0; hit <= said; hit++) if (n - real - said + 2 * hit >= found) as_good += choose(real, hit) * choose(n - real, said - hit);
    return as_good / choose(n, said);
  }
  function verdict() {
    var said = guesses.filter(function (g) { return g !== null; }).length, n = answers.length;
    var found = guesses.filter(function (g, i) { return g === answers[i][0]; }).length;
    if (!said) return "You did not guess.";
    if (said < n) return found + " of " + said + " right; " + (n - said) + " not guessed.";
    var marked = guesses.filter(function (g) { return g === 1; }).length;
    return found + " of " + n + " right. By luck alone as many or more are right in " + (100 * luck(found, marked)).toFixed(0) + " % of cases.";
  }
  function show() {
    figures.forEach(function (figure, i) {
      figure.querySelectorAll("[data-guess]").forEach(function (button) {
        button.setAttribute("aria-pressed", String(Number(button.dataset.guess) === guesses[i])); button.disabled = revealed;
      });
      var answer = figure.querySelector(".answer"), right = guesses[i] === answers[i][0];
      answer.hidden = !revealed;
      answer.textContent = revealed ? (answers[i][0] ? "real: " : "emulated: ") + answers[i][1] + (guesses[i] === null ? "" : right ? " (right)" : " (wrong)") : "";
      figure.classList.toggle("right", revealed && right);
      figure.classList.toggle("wrong", revealed && guesses[i] !== null && !right);
    });
    $("score").textContent = revealed ? verdict() : "";
    $("reveal").textContent = revealed ? "Hide and guess again" : "Who is real?";
  }
  function reveal() {
    revealed = !revealed;
    if (!revealed) guesses = guesses.map(function () { return null; });
    show();
  }

  $("reveal").addEventListener("click", reveal);
  figures.forEach(function (figure, i) {
    figure.querySelectorAll("[data-guess]").forEach(function (button) {
      button.addEventListener("click", function () { mark(i, Number(button.dataset.guess)); });
    });
  });
  show();
})();
