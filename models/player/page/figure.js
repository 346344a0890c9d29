// A body, and a face of landmarks, drawn from points.

// Parts of OpenPose's face, by the numbers of its 70 points.
const FACE_LINES = [
  { part: "contour", points: range(0, 17) }, { part: "brow", points: range(17, 22) },
  { part: "brow", points: range(22, 27) }, { part: "nose", points: range(27, 31) },
  { part: "nose", points: range(31, 36) }, { part: "eye", points: range(36, 42), closed: true },
  { part: "eye", points: range(42, 48), closed: true },
  { part: "lips", points: range(48, 60), closed: true },
  { part: "lips", points: range(60, 68), closed: true },
];

function range(begin, end) {
  return Array.from({ length: end - begin }, (_, i) => begin + i);
}

// "right" or "left" beyond a shoulder, else "body".
function sideOf(name) {
  if (/^(Neck|Nose)|Eye$|Shoulder$/.test(name)) return "body";
  return name.startsWith("R") ? "right" : name.startsWith("L") ? "left" : "body";
}

// A smooth line through points.
function smooth(context, points, closed = false) {
  const n = points.length, at = (i) => closed ? points[(i + n) % n] : points[Math.min(Math.max(i, 0), n - 1)];
  context.beginPath();
  context.moveTo(...at(0));
  for (let i = 0; i < (closed ? n : n - 1); ++i) {
    const [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
    context.bezierCurveTo(b[0] + (c[0] - a[0]) / 6, b[1] + (c[1] - a[1]) / 6,
                          c[0] - (d[0] - b[0]) / 6, c[1] - (d[1] - b[1]) / 6, c[0], c[1]);
  }
  if (closed) context.closePath();
}

// A limb that is `ra` thick (in radius) at `a` and `rb` at `b`.
function limb(context, a, b, ra, rb) {
  const angle = Math.atan2(b[1] - a[1], b[0] - a[0]);
  context.beginPath();
  context.arc(a[0], a[1], ra, angle + Math.PI / 2, angle - Math.PI / 2);
  context.arc(b[0], b[1], rb, angle - Math.PI / 2, angle + Math.PI / 2);
  context.closePath();
  context.fill();
}

function disc(context, [x, y], radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

class BodyDrawing {
  constructor(motion) {
    this.motion = motion;
    this.unit = motion.shoulder;
    const { names, parents } = motion.body;
    this.bones = parents.flatMap((parent, point) => {
      const name = names[point];
      if (parent < 0 || /^Nose$|Eye$/.test(name)) return [];
      return [{ from: parent, to: point, side: sideOf(name), width: this.widthOf(name) }];
    });
    this.joints = names.map((name) => ({ side: sideOf(name), hidden: /^Nose$|Eye$|Hand|^Neck$/.test(name) }));
    this.wrists = ["RWrist", "LWrist"].map((name) => motion.body.byName.get(name))
      .filter((point) => point !== undefined);
  }

  // Radii at both ends of the bone to the joint `name`, in shoulder lengths.
  widthOf(name) {
    if (name.endsWith("Shoulder")) return [0.05, 0.075];
    if (name.endsWith("Elbow")) return [0.085, 0.066];
    if (name.endsWith("Wrist")) return [0.066, 0.048];
    if (name.endsWith("HandRoot")) return [0.05, 0.038];
    return [0.022, 0.018];
  }

  // Left, top, right and bottom of what is drawn, as far as an arm could reach.
  extent() {
    const { body, face, frames } = this.motion, xs = [], ys = [];
    const step = Math.max(1, Math.floor(frames / 500));
    for (const figure of face ? [body, face] : [body]) {
      for (let frame = 0; frame < frames; frame += step) {
        for (let point = 0; point < figure.names.length; ++point) {
          const [x, y] = figure.point(frame, point);
          xs.push(x);
          ys.push(y);
        }
      }
    }
    xs.sort((a, b) => a - b);
    ys.sort((a, b) => a - b);
    const u = this.unit, least = (sorted) => sorted[0], most = (sorted) => sorted[sorted.length - 1];
    const within = (value, low, high) => Math.min(Math.max(value, low * u), high * u);
    return { left: within(least(xs) - 0.1 * u, -3.5, -1.25), right: within(most(xs) + 0.1 * u, 1.25, 3.5),
             top: within(least(ys) - 0.2 * u, -3, -1.5), bottom: within(most(ys) + 0.1 * u, 2.2, 4) };
  }

  headOf(points) {
    const { byName } = this.motion.body, place = (name) => points[byName.get(name)];
    const nose = place("Nose"), right = place("REye"), left = place("LEye");
    if (!nose && !(right && left)) return null;
    const middle = right && left ? [(right[0] + left[0]) / 2, (right[1] + left[1]) / 2] : nose;
    const tilt = right && left ? Math.atan2(left[1] - right[1], left[0] - right[0]) : 0;
    const centre = nose ? [(nose[0] + middle[0]) / 2, (nose[1] + middle[1]) / 2] : middle;
    return { centre, nose, right, left, tilt: Math.abs(tilt) < 1.2 ? tilt : 0 };
  }

  // Draws the figure at `time`; the context's unit is the figure's.
  draw(context, time, palette, { trails, closeUp }) {
    this.pen = (closeUp ? 0.02 : 0.032) * this.unit;
    const points = this.motion.body.at(this.motion, time), head = this.headOf(points);
    context.lineCap = context.lineJoin = "round";
    this.drawTorso(context, points, palette);
    if (trails) this.wrists.forEach((wrist, i) => this.drawTrail(context, wrist, time, palette[i ? "left" : "right"]));
    if (head) {
      this.drawNeck(context, head.centre, palette);
    }
    for (const { from, to, side, width } of this.bones) {
      context.fillStyle = palette[side];
      limb(context, points[from], points[to], width[0] * this.unit, width[1] * this.unit);
    }
    context.fillStyle = palette.joint;
    this.joints.forEach(({ hidden }, point) => {
      if (!hidden) disc(context, points[point], 0.026 * this.unit);
    });
    if (this.motion.face) {
      drawLandmarks(context, this.motion, time, palette, head, this.pen);
    } else if (head) {
      this.drawHead(context, head, palette);
    }
  }

  // Below the shoulders, fading out: what carries the arms, though no network makes it.
  drawTorso(context, points, palette) {
    const { byName } = this.motion.body, u = this.unit;
    const right = points[byName.get("RShoulder")], left = points[byName.get("LShoulder")];
    if (!right || !left) return;
    const middle = (right[0] + left[0]) / 2, side = right[0] < left[0] ? 1 : -1;
    const fade = context.createLinearGradient(0, 0, 0, 2.3 * u);
    fade.addColorStop(0, palette.torso);
    fade.addColorStop(1, palette.torsoEnd);
    context.fillStyle = fade;
    context.beginPath();
    context.moveTo(right[0] - 0.02 * side * u, right[1]);
    context.quadraticCurveTo(right[0] / 2, Math.min(right[1], 0) - 0.08 * u, 0, -0.06 * u);
    context.quadraticCurveTo(left[0] / 2, Math.min(left[1], 0) - 0.08 * u, left[0] + 0.02 * side * u, left[1]);
    context.quadraticCurveTo(middle + side * 0.72 * u, 1.2 * u, middle + side * 0.66 * u, 2.3 * u);
    context.lineTo(middle - side * 0.66 * u, 2.3 * u);
    context.quadraticCurveTo(middle - side * 0.72 * u, 1.2 * u, right[0] - 0.02 * side * u, right[1]);
    context.fill();
  }

  drawNeck(context, [x, y], palette) {
    const u = this.unit;
    context.fillStyle = palette.skin;
    context.strokeStyle = palette.body;
    context.lineWidth = this.pen;
    context.beginPath();
    context.moveTo(-0.2 * u, 0.02 * u);
    context.quadraticCurveTo(x / 2 - 0.12 * u, -0.05 * u, x / 2 - 0.12 * u, y / 2);
    context.lineTo(x - 0.1 * u, y);
    context.lineTo(x + 0.1 * u, y);
    context.lineTo(x / 2 + 0.12 * u, y / 2);
    context.quadraticCurveTo(x / 2 + 0.12 * u, -0.05 * u, 0.2 * u, 0.02 * u);
    context.fill();
    context.stroke();
  }

  // Where a wrist has been for the last 0.8 s.
  drawTrail(context, wrist, time, colour) {
    const steps = 24, { motion } = this, begin = Math.max(0, time - 0.8);
    if (time <= begin) return;
    const at = (moment) => {
      const { before, after, share } = between(motion, moment);
      const [ax, ay] = motion.body.point(before, wrist), [bx, by] = motion.body.point(after, wrist);
      return [ax + share * (bx - ax), ay + share * (by - ay)];
    };
    context.strokeStyle = colour;
    context.lineCap = "butt";
    for (let i = 0; i < steps; ++i) {
      context.globalAlpha = 0.5 * ((i + 1) / steps) ** 1.5;
      context.lineWidth = 0.035 * this.unit * (0.3 + 0.7 * i / steps);
      context.beginPath();
      context.moveTo(...at(begin + (time - begin) * i / steps));
      context.lineTo(...at(begin + (time - begin) * (i + 1) / steps));
      context.stroke();
    }
    context.globalAlpha = 1;
    context.lineCap = "round";
  }

  drawHead(context, { centre, nose, right, left, tilt }, palette) {
    const u = this.unit;
    context.save();
    context.translate(...centre);
    context.rotate(tilt);
    context.beginPath();
    context.ellipse(0, -0.02 * u, 0.34 * u, 0.42 * u, 0, 0, 2 * Math.PI);
    context.fillStyle = palette.skin;
    context.fill();
    context.strokeStyle = palette.body;
    context.lineWidth = this.pen;
    context.stroke();
    context.restore();
    context.fillStyle = palette.body;
    for (const eye of [right, left]) if (eye) disc(context, eye, 0.034 * u);
    if (nose) disc(context, nose, 0.026 * u);
  }
}

// The face of landmarks; what the network leaves out is left out.
function drawLandmarks(context, motion, time, palette, head, pen) {
  const face = motion.face, u = motion.shoulder, points = face.at(motion, time);
  const present = (sources) => sources.filter((source) => face.bySource.has(source))
    .map((source) => points[face.bySource.get(source)]);
  const contour = present(FACE_LINES[0].points);
  context.strokeStyle = palette.body;
  context.fillStyle = palette.skin;
  context.lineWidth = pen;
  if (contour.length >= 3) {
    smooth(context, [...contour, ...forehead(contour)], true);
    context.fill();
    context.stroke();
  }
  if (contour.length === 0 && head) disc(context, head.centre, 0.4 * u);
  for (const { part, points: sources, closed } of FACE_LINES.slice(1)) {
    const line = present(sources);
    if (line.length === 0) continue;
    context.strokeStyle = context.fillStyle = part === "brow" ? palette.brow : palette.body;
    context.lineWidth = (part === "brow" ? 1.4 : 0.8) * pen;
    if (part === "eye" && line.length < 4) {
      drawEye(context, line, u, palette);
    } else if (line.length === 1) {
      disc(context, line[0], 0.02 * u);
    } else {
      smooth(context, line, closed && line.length > 2);
      context.stroke();
    }
  }
  context.fillStyle = palette.body;
  for (const pupil of present([68, 69])) disc(context, pupil, 0.025 * u);
  if (head && head.nose && !face.bySource.has(30)) disc(context, head.nose, 0.024 * u);
}

// From the last point of the contour over the top to the first.
function forehead(contour) {
  const [ax, ay] = contour[contour.length - 1], [bx, by] = contour[0];
  const half = [(bx - ax) / 2, (by - ay) / 2], up = bx > ax ? 0.95 : -0.95;
  return [30, 60, 90, 120, 150].map((degrees) => {
    const along = 1 - Math.cos(degrees * Math.PI / 180), lift = up * Math.sin(degrees * Math.PI / 180);
    return [ax + along * half[0] + lift * half[1], ay + along * half[1] - lift * half[0]];
  });
}

// An eye of which only the lids are known, the upper and the lower.
function drawEye(context, lids, u, palette) {
  const upper = lids[0], lower = lids[lids.length - 1];
  const height = Math.max(Math.hypot(lower[0] - upper[0], lower[1] - upper[1]) / 2, 0.012 * u);
  const x = (upper[0] + lower[0]) / 2, y = (upper[1] + lower[1]) / 2;
  const outline = () => {
    context.beginPath();
    context.ellipse(x, y, 0.08 * u, Math.min(height, 0.09 * u), 0, 0, 2 * Math.PI);
  };
  outline();
  context.fillStyle = palette.eye;
  context.fill();
  context.save();
  context.clip();
  context.fillStyle = palette.pupil;
  disc(context, [x, y], 0.038 * u);
  context.restore();
  outline();
  context.stroke();
}
