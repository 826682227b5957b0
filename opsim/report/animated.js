// Moves the bodies of the page, and keeps the reader's guesses. The frames stand in the page as whole mm.
(function () {
  "use strict";
  var LIFT = 0.17, HOLD_S = 0.8, FLOOR_M = -0.03, SQUARE_M = 0.25, STEADY_M = 0.15;
  var film = JSON.parse(document.getElementById("film").textContent), body = film.body;
  var frames = film.cards.map(unpacked), usual = frames.map(average), answers = JSON.parse(atob(film.answers));
  var figures = Array.prototype.slice.call(document.querySelectorAll(".card"));
  var guesses = frames.map(function () { return null; });
  var longest = Math.max.apply(null, frames.map(lasts)), end = longest + HOLD_S;
  var at = 0, speed = 1, turn = film.turn_deg, playing = false, revealed = false, before = null, bounds = measured();
  function $(id) { return document.getElementById(id); }

  function unpacked(text) {
    var raw = atob(text), bytes = new Uint8Array(raw.length);
    for (var i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    var view = new DataView(bytes.buffer), metres = new Float32Array(raw.length / 2);
    for (i = 0; i < metres.length; i++) metres[i] = view.getInt16(2 * i, true) / 1000;
    return metres;
  }
  function lasts(metres) { return (metres.length / (3 * film.joints) - 1) / film.rate_hz; }

  // The joints of one card at a time, straight between frames; before and after, its first and last posture.
  function posture(metres, time_s) {
    var n = 3 * film.joints, last = metres.length / n - 1;
    var place = Math.min(Math.max(time_s * film.rate_hz, 0), last), low = Math.min(Math.floor(place), last - 1);
    var share = place - low, joints = new Float32Array(n);
    for (var i = 0; i < n; i++) joints[i] = (1 - share) * metres[low * n + i] + share * metres[(low + 1) * n + i];
    return joints;
  }
  function average(metres) {
    var n = 3 * film.joints, joints = new Float32Array(n);
    for (var i = 0; i < metres.length; i++) joints[i % n] += metres[i] * n / metres.length;
    return joints;
  }
  // What all cards share: the middle of their ways, and the room that every view of them needs.
  function measured() {
    var low = [1e9, 1e9], high = [-1e9, -1e9], tall = 0, wide = 0, n = 3 * film.joints;
    frames.forEach(function (metres) {
      for (var i = 3 * body.root; i < metres.length; i += n) [0, 1].forEach(function (c) {
        low[c] = Math.min(low[c], metres[i + c]); high[c] = Math.max(high[c], metres[i + c]);
      });
    });
    var middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    frames.forEach(function (metres) {
      for (var i = 0; i < metres.length; i += 3) {
        var root = i - i % n + 3 * body.root, x = film.follow ? metres[root] : middle[0], y = film.follow ? metres[root + 1] : middle[1];
        wide = Math.max(wide, Math.hypot(metres[i] - x, metres[i + 1] - y));
        tall = Math.max(tall, metres[i + 2]);
      }
    });
    return { middle: middle, wide: Math.max(wide, 0.45) + 0.1, tall: tall + 0.16 };
  }

  // From metres to the picture: x to the right, y down, depth towards the viewer.
  function camera(canvas, joints) {
    var angle = turn * Math.PI / 180, c = Math.cos(angle), s = Math.sin(angle), up = Math.cos(LIFT), lean = Math.sin(LIFT);
    var root = 3 * body.root, middle = film.follow ? [joints[root], joints[root + 1]] : bounds.middle;
    var scale = canvas.width / (2 * bounds.wide);
    function see(x, y, z) {
      var near = (x - middle[0]) * c + (y - middle[1]) * s, across = (y - middle[1]) * c - (x - middle[0]) * s;
      var high = bounds.wide * lean + (z - FLOOR_M) * up - near * lean;
      return { x: canvas.width / 2 + scale * across, y: canvas.height - scale * high, near: near * up + z * lean };
    }
    return { see: see, scale: scale, middle: middle };
  }
  function line(g, from, to) { g.beginPath(); g.moveTo(from.x, from.y); g.lineTo(to.x, to.y); g.stroke(); }

  function ground(g, view) {
    var reach = bounds.wide - 0.04;
    g.strokeStyle = "#dde2e8"; g.lineWidth = Math.max(1, 0.004 * view.scale);
    [0, 1].forEach(function (c) {
      var here = view.middle[c], other = view.middle[1 - c];
      for (var k = Math.ceil((here - reach) / SQUARE_M); k * SQUARE_M <= here + reach; k++) {
        var off = k * SQUARE_M - here, half = Math.sqrt(Math.max(0, reach * reach - off * off));
        var ends = [other - half, other + half].map(function (way) {
          return c ? view.see(way, k * SQUARE_M, FLOOR_M) : view.see(k * SQUARE_M, way, FLOOR_M);
        });
        line(g, ends[0], ends[1]);
      }
    });
  }
  function shadows(g, view, joints) {
    body.feet.forEach(function (j) {
      var foot = view.see(joints[3 * j], joints[3 * j + 1], FLOOR_M), high = Math.max(joints[3 * j + 2], 0);
      g.fillStyle = "rgba(40, 46, 54, " + (0.28 * Math.exp(-high / 0.12)).toFixed(3) + ")";
      g.beginPath(); g.ellipse(foot.x, foot.y, 0.075 * view.scale, 0.02 * view.scale, 0, 0, 2 * Math.PI); g.fill();
    });
  }
  // The outline of a limb: two circles and their outer tangents.
  function limb(g, a, b, ra, rb) {
    var far = Math.hypot(b.x - a.x, b.y - a.y), angle = Math.atan2(b.y - a.y, b.x - a.x);
    g.beginPath();
    if (far <= Math.abs(ra - rb) + 1e-6) { g.arc((ra > rb ? a : b).x, (ra > rb ? a : b).y, Math.max(ra, rb), 0, 2 * Math.PI); return; }
    var open = Math.acos((ra - rb) / far);
    g.arc(a.x, a.y, ra, angle + open, angle - open + 2 * Math.PI);
    g.arc(b.x, b.y, rb, angle - open, angle + open);
    g.closePath();
  }
  // Every part with its nearness to the viewer; the far ones are drawn first, each on a white rim. A limb that is about as
  // far before the torso as it usually is keeps its place in that order, else it would flicker where both are as near.
  function parts(view, joints, usual_joints) {
    var found = [], seen = all(view, joints), often = all(view, usual_joints), mm = view.scale / 1000, trunk = body.colours[0];
    var torso = body.torso.length ? body.torso : [body.root], here = mean(torso, seen), there = mean(torso, often);
    body.bones.forEach(function (bone) {
      var ends = [bone[0], bone[1]], now = mean(ends, seen) - here, then = mean(ends, often) - there;
      var near = bone[4] ? (Math.abs(now - then) < STEADY_M ? then : now) : now - 0.3;
      found.push({ near: near, colour: body.colours[bone[4]], outline: function (g) {
        limb(g, seen[bone[0]], seen[bone[1]], bone[2] * mm, bone[3] * mm);
      } });
    });
    if (body.torso.length) found.push({ near: -0.02, colour: trunk, wide: 2 * body.torso_mm * mm, outline: function (g) {
      g.beginPath(); body.torso.forEach(function (j) { g.lineTo(seen[j].x, seen[j].y); }); g.closePath();
    } });
    if (body.head >= 0) found.push({ near: seen[body.head].near - here, colour: trunk, outline: function (g) {
      g.beginPath(); g.arc(seen[body.head].x, seen[body.head].y, body.head_mm * mm, 0, 2 * Math.PI);
    } });
    return found.sort(function (a, b) { return a.near - b.near; });
  }
  function all(view, joints) {
    for (var seen = [], j = 0; j < joints.length; j += 3) seen.push(view.see(joints[j], joints[j + 1], joints[j + 2]));
    return seen;
  }
  function mean(joints, seen) { return joints.reduce(function (sum, j) { return sum + seen[j].near; }, 0) / joints.length; }

  function paint(figure, i) {
    var canvas = figure.querySelector("canvas"), g = canvas.getContext("2d"), joints = posture(frames[i], at);
    var view = camera(canvas, joints), rim = Math.max(1.5, 0.012 * view.scale);
    g.clearRect(0, 0, canvas.width, canvas.height);
    g.lineJoin = g.lineCap = "round";
    ground(g, view);
    shadows(g, view, joints);
    parts(view, joints, usual[i]).forEach(function (part) {
      var wide = part.wide || 0;
      part.outline(g);
      g.strokeStyle = "#fff"; g.lineWidth = wide + 2 * rim; g.stroke();
      g.fillStyle = g.strokeStyle = part.colour; g.fill();
      if (wide) { g.lineWidth = wide; g.stroke(); }
    });
    figure.querySelector(".ends i").style.width = 100 * Math.min(at, lasts(frames[i])) / longest + "%";
  }
  function draw() {
    figures.forEach(function (figure, i) { paint(figure, i); });
    $("time").value = at; $("clock").textContent = Math.min(at, longest).toFixed(1) + " s"; $("turn").value = turn;
  }
  function fit() {
    figures.forEach(function (figure) {
      var canvas = figure.querySelector("canvas"), dense = Math.min(window.devicePixelRatio || 1, 2);
      var tall = (bounds.tall - FLOOR_M) * Math.cos(LIFT) + 2 * bounds.wide * Math.sin(LIFT);
      canvas.width = Math.round(canvas.clientWidth * dense);
      canvas.height = Math.round(canvas.width * tall / (2 * bounds.wide));
    });
    draw();
  }

  function tick(now) {
    if (!playing) return;
    if (before !== null) at += speed * (now - before) / 1000;
    if (at > end) at = 0;
    before = now; draw(); window.requestAnimationFrame(tick);
  }
  function play(on) {
    playing = on; before = null;
    $("play").textContent = on ? "Pause" : "Play"; $("play").setAttribute("aria-pressed", on);
    if (on) window.requestAnimationFrame(tick);
  }
  function seek(time_s) { at = Math.min(Math.max(time_s, 0), end); draw(); }
  function setTurn(degrees) { turn = ((degrees + 540) % 360) - 180; draw(); }

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

  $("play").addEventListener("click", function () { play(!playing); });
  $("time").max = end;
  $("time").addEventListener("input", function () { play(false); seek(Number(this.value)); });
  $("turn").addEventListener("input", function () { setTurn(Number(this.value)); });
  $("speed").addEventListener("change", function () { speed = Number(this.value); });
  $("reveal").addEventListener("click", reveal);
  figures.forEach(function (figure, i) {
    figure.querySelectorAll("[data-guess]").forEach(function (button) {
      button.addEventListener("click", function () { mark(i, Number(button.dataset.guess)); });
    });
    var canvas = figure.querySelector("canvas"), grip = null;
    canvas.addEventListener("pointerdown", function (event) { grip = [event.clientX, turn]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointermove", function (event) { if (grip) setTurn(grip[1] - (event.clientX - grip[0]) / 2); });
    ["pointerup", "pointercancel"].forEach(function (kind) { canvas.addEventListener(kind, function () { grip = null; }); });
  });
  document.addEventListener("keydown", function (event) {
    var on = event.target.tagName;
    if (event.ctrlKey || event.metaKey || event.altKey || on === "SELECT" || (on === "BUTTON" && event.key === " ")) return;
    if (event.key === " ") play(!playing);
    else if (on !== "INPUT" && event.key === "ArrowRight") { play(false); seek(at + 1 / film.rate_hz); }
    else if (on !== "INPUT" && event.key === "ArrowLeft") { play(false); seek(at - 1 / film.rate_hz); }
    else if ("1234".indexOf(event.key) >= 0) { $("speed").selectedIndex = Number(event.key) - 1; speed = Number($("speed").value); }
    else return;
    event.preventDefault();
  });
  window.addEventListener("resize", fit);
  fit(); show();
  if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
  document.documentElement.setAttribute("data-drawn", frames.length);
})();
