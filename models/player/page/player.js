// Brings the parts together: what is shown when, and what keys and buttons do.

const byId = (id) => document.getElementById(id);
const show = readShow();
const clock = new Clock(byId("sound"), show.seconds);
const stage = new Stage(byId("stage"), show);
const timeline = new Timeline(byId("tracks"), show);
const caption = new Caption(byId("caption"), show.words, seek);
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
const dark = window.matchMedia("(prefers-color-scheme: dark)");
const { rate, frames } = show.prediction;
let palette = {}, looping = false, pending = false, spoken = 0;

const COLOURS = ["ink", "muted", "line", "ground", "accent", "onAccent", "word", "wave", "spectrum", "pitch", "body",
  "right", "left", "joint", "skin", "pupil", "torso", "torsoEnd", "hair", "cheek", "eye", "brow", "source", "target"];

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  const style = getComputedStyle(document.documentElement);
  for (const colour of COLOURS) palette[colour] = style.getPropertyValue("--" + colour).trim();
  palette.prediction = palette.accent;
  timeline.stale = true;
  invalidate();
}

// Draws soon; while it plays, for every picture of the screen.
function invalidate() {
  if (pending) return;
  pending = true;
  requestAnimationFrame((now) => {
    pending = false;
    draw(now);
    if (clock.playing) invalidate();
  });
}

function draw(now) {
  let time = clock.tick(now);
  const end = timeline.loop ? timeline.loop.end : show.seconds;
  if (looping && time >= end - 1e-3 && (clock.playing || time >= show.seconds)) {
    const begin = timeline.loop ? timeline.loop.begin : 0;
    const ended = !clock.playing;
    clock.seek(begin);
    if (ended) clock.play();
    time = begin;
  }
  timeline.follow(time, clock.playing);
  stage.draw(time, palette);
  timeline.draw(time, palette, looping);
  caption.show(time);
  say(time, now);
}

// Everything in words and numbers.
function say(time, now) {
  byId("time").textContent = clockText(time, 2);
  byId("frame").textContent = Math.min(Math.floor(time * rate + 1e-6), frames - 1);
  byId("play").classList.toggle("playing", clock.playing);
  byId("play").setAttribute("aria-label", clock.playing ? "Pause" : "Play");
  if (clock.complaint) complain(clock.complaint);
  if (clock.playing && now - spoken < 500) return;
  spoken = now;
  const word = wordAt(show.words, time), tracks = byId("tracks");
  tracks.setAttribute("aria-valuenow", time.toFixed(2));
  tracks.setAttribute("aria-valuetext", `${time.toFixed(1)} of ${show.seconds.toFixed(1)} seconds` +
    (word >= 0 ? `, “${show.words[word][0]}”` : ""));
}

function complain(text) {
  const note = byId("untrained");
  note.textContent = text;
  note.hidden = false;
}

function seek(time) {
  clock.seek(time);
  invalidate();
}

function toggle() {
  if (clock.playing) clock.pause();
  else clock.play().then(invalidate);
  invalidate();
}

function step(count) {
  clock.pause();
  const frame = count > 0 ? Math.floor(clock.shown * rate + 1e-4) + count : Math.ceil(clock.shown * rate - 1e-4) + count;
  seek(Math.min(Math.max(frame, 0), frames - 1) / rate);
}

function stepWord(count) {
  const starts = show.words.map((word) => word[1]);
  const next = count > 0 ? starts.find((start) => start > clock.shown + 1e-3)
    : starts.findLast((start) => start < clock.shown - 1e-3);
  if (next !== undefined) seek(next);
}

function setSpeed(index) {
  const select = byId("speed");
  select.selectedIndex = Math.min(Math.max(index, 0), select.options.length - 1);
  clock.setRate(Number(select.value));
}

function setLooping(on) {
  looping = on;
  byId("loop").setAttribute("aria-pressed", on);
  invalidate();
}

function chooseLoop(loop) {
  timeline.setLoop(loop);
  if (timeline.loop) setLooping(true);
  invalidate();
}

function press(id, member) {
  stage[member] = !stage[member];
  byId(id).setAttribute("aria-pressed", stage[member]);
  invalidate();
}

function zoom(factor) {
  timeline.zoom(factor, clock.shown);
  invalidate();
}

const swapTheme = () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
const ACTIONS = {
  " ": toggle, k: toggle,
  ArrowLeft: (shift) => shift ? seek(clock.shown - 1) : step(-1),
  ArrowRight: (shift) => shift ? seek(clock.shown + 1) : step(1),
  ArrowUp: () => setSpeed(byId("speed").selectedIndex + 1),
  ArrowDown: () => setSpeed(byId("speed").selectedIndex - 1),
  ",": () => stepWord(-1), ".": () => stepWord(1),
  Home: () => seek(0), End: () => seek(show.seconds),
  "[": () => chooseLoop({ begin: clock.shown, end: loopEnd() }),
  "]": () => chooseLoop({ begin: timeline.loop ? Math.min(timeline.loop.begin, clock.shown) : 0, end: clock.shown }),
  l: () => setLooping(!looping),
  Escape: () => { timeline.setLoop(null); setLooping(false); },
  "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), 0: () => zoom(1e9),
  t: () => { if (stage.hasBody) press("trails", "trails"); },
  f: () => { if (stage.hasBody) press("close-up", "closeUp"); },
  d: swapTheme,
  "?": () => byId("help").showModal(),
};

function loopEnd() {
  return timeline.loop && timeline.loop.end > clock.shown + 0.05 ? timeline.loop.end : show.seconds;
}

document.addEventListener("keydown", (event) => {
  const typed = event.getModifierState("AltGraph");
  if (byId("help").open || ((event.ctrlKey || event.metaKey || event.altKey) && !typed)) return;
  const target = event.target;
  if (target.tagName === "SELECT" && event.key !== "Escape") return;
  if (target.tagName === "BUTTON" && (event.key === " " || event.key === "Enter")) return;
  const action = ACTIONS[event.key] ?? ACTIONS[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action(event.shiftKey);
});

const CLICKS = {
  play: toggle, back: () => step(-1), forward: () => step(1), loop: ACTIONS.l, trails: ACTIONS.t,
  "close-up": ACTIONS.f, "zoom-in": () => zoom(0.5), "zoom-out": () => zoom(2), theme: swapTheme,
  "help-open": ACTIONS["?"],
};
for (const [id, action] of Object.entries(CLICKS)) byId(id).addEventListener("click", () => action(false));
byId("speed").addEventListener("change", () => setSpeed(byId("speed").selectedIndex));
byId("tracks").addEventListener("wheel", (event) => {
  if (!event.ctrlKey) return;  // a pinch, or a wheel that means to zoom
  event.preventDefault();
  const box = byId("tracks").getBoundingClientRect();
  timeline.zoom(event.deltaY > 0 ? 1.25 : 0.8, timeline.timeAt(event.clientX - box.left));
  invalidate();
}, { passive: false });
timeline.onSeek = seek;
timeline.onLoop = chooseLoop;
dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));

function introduce() {
  const { normalised } = show.prediction, parts = [show.network];
  parts.push(`${frames} ${frames === 1 ? "frame" : "frames"} at ${Number(rate.toFixed(3))} a second`);
  if (!normalised) parts.push("pixels");
  if (show.trained && show.weights) parts.push(show.weights);
  byId("about").textContent = parts.filter((part) => part).join(" · ");
  if (!show.trained) complain("Untrained weights: the numbers of this network are random, so the motion is noise. " + show.weights);
  byId("length").textContent = "/ " + clockText(show.seconds, 2);
  byId("frames").textContent = frames;
  byId("tracks").setAttribute("aria-valuemax", show.seconds.toFixed(2));
  byId("close-up").hidden = byId("trails").hidden = !stage.hasBody;
  document.body.classList.add(show.takes.length > 1 ? "compare" : "solo");
  document.body.classList.toggle("mute", !clock.sound);
  if (calm.matches) press("trails", "trails");
}

introduce();
setTheme(dark.matches ? "dark" : "light");
new ResizeObserver(() => {
  stage.resize();
  timeline.layout();
  draw(performance.now());
}).observe(document.body);
stage.resize();
timeline.layout();
invalidate();
