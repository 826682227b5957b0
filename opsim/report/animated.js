// Moves the bodies of the page. The frames stand in the page as whole mm, the camera as opsim.report.camera gives it.
(function () {
  "use strict";
  var film = JSON.parse(document.getElementById("film").textContent), body = film.body, stage = film.camera;
  var frames = film.cards.map(unpacked), usual = frames.map(average);
  var figures = Array.prototype.slice.call(document.querySelectorAll(".card"));
  var longest = Math.max.apply(null, frames.map(lasts)), end = longest + film.hold_s;
  var at = 0, speed = 1, turn = stage.turn_deg, playing = false, before = null;
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

  // From metres to the picture: x to the right, y down, depth towards the viewer.
  function camera(canvas, joints) {
    var angle = turn * Math.PI / 180, c = Math.cos(angle), s = Math.sin(angle), up = Math.cos(stage.lift), lean = Math.sin(stage.lift);
    var root = 3 * body.root, middle = stage.follow ? [joints[root], joints[root + 1]] : stage.middle;
    var scale = canvas.width / (2 * stage.wide);
    function see(x, y, z) {
      var near = (x - middle[0]) * c + (y - middle[1]) * s, across = (y - middle[1]) * c - (x - middle[0]) * s;
      var high = stage.wide * lean + (z - stage.floor) * up - near * lean;
      return { x: canvas.width / 2 + scale * across, y: canvas.height - scale * high, near: near * up + z * lean };
    }
    return { see: see, scale: scale, middle: middle };
  }
  function line(g, from, to) { g.beginPath(); g.moveTo(from.x, from.y); g.lineTo(to.x, to.y); g.stroke(); }

  function ground(g, view) {
    var reach = stage.wide - 0.04;
    g.strokeStyle = "#dde2e8"; g.lineWidth = Math.max(1, 0.004 * view.scale);
    [0, 1].forEach(function (c) {
      var here = view.middle[c], other = view.middle[1 - c];
      for (var k = Math.ceil((here - reach) / stage.square); k * stage.square <= here + reach; k++) {
        var off = k * stage.square - here, half = Math.sqrt(Math.max(0, reach * reach - off * off));
        var ends = [other - half, other + half].map(function (way) {
          return c ? view.see(way, k * stage.square, stage.floor) : view.see(k * stage.square, way, stage.floor);
        });
        line(g, ends[0], ends[1]);
      }
    });
  }
  function shadows(g, view, joints) {
    body.feet.forEach(function (j) {
      var foot = view.see(joints[3 * j], joints[3 * j + 1], stage.floor), high = Math.max(joints[3 * j + 2], 0);
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
      var near = bone[4] ? (Math.abs(now - then) < film.steady_m ? then : now) : now - 0.3;
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
      var tall = (stage.tall - stage.floor) * Math.cos(stage.lift) + 2 * stage.wide * Math.sin(stage.lift);
      canvas.width = Math.round(canvas.clientWidth * dense);
      canvas.height = Math.round(canvas.width * tall / (2 * stage.wide));
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

  $("play").addEventListener("click", function () { play(!playing); });
  $("time").max = end;
  $("time").addEventListener("input", function () { play(false); seek(Number(this.value)); });
  $("turn").addEventListener("input", function () { setTurn(Number(this.value)); });
  $("speed").addEventListener("change", function () { speed = Number(this.value); });
  figures.forEach(function (figure) {
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
  fit();
  if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
  document.documentElement.setAttribute("data-drawn", frames.length);
})();
