// A schematic face that action units move and head angles turn.
//
// It lies on an ellipsoid of height 2: x to the right of the picture, y down, z away from who looks.
// Angles are OpenFace's pose_Rx, Ry and Rz, R = Rx Ry Rz, so that Rx > 0 looks down.

const HEAD = [0.76, 1, 0.86];  // half axes

function rotation(rx, ry, rz) {
  const [s1, s2, s3] = [rx, ry, rz].map(Math.sin), [c1, c2, c3] = [rx, ry, rz].map(Math.cos);
  return [[c2 * c3, -c2 * s3, s2],
          [c1 * s3 + c3 * s1 * s2, c1 * c3 - s1 * s2 * s3, -c2 * s1],
          [s1 * s3 - c1 * c3 * s2, c3 * s1 + c1 * s2 * s3, c1 * c2]];
}

class HeadDrawing {
  constructor(motion) {
    this.motion = motion;
    this.curves = new Map(motion.curves.map((curve) => [curve.name, curve]));
  }

  // Draws the head at `time` around 0, 0; 1 is half its height.
  draw(context, time, palette) {
    const value = (name) => this.curves.has(name) ? this.curves.get(name).at(this.motion, time) : 0;
    const unit = (name) => Math.min(Math.max(value(name) / 5, 0), 1);
    const matrix = rotation(value("Rx"), value("Ry"), value("Rz"));
    this.project = ([x, y, z]) => {
      const [px, py, pz] = matrix.map((row) => row[0] * x + row[1] * y + row[2] * z);
      const near = 1 / (1 + 0.12 * pz);
      return [px * near, py * near];
    };
    context.lineCap = context.lineJoin = "round";
    this.drawBust(context, palette);
    this.drawSkull(context, matrix, palette);
    this.drawCheeks(context, unit, palette);
    for (const side of [-1, 1]) {
      this.drawEye(context, side, unit, palette);
      this.drawBrow(context, side, unit, palette);
    }
    this.drawNoseAndMouth(context, unit, palette);
  }

  // A point of the face that is seen at x, y from the front, `out` in front of the surface.
  surface(x, y, out = 0) {
    const z = -HEAD[2] * Math.sqrt(Math.max(1 - (x / HEAD[0]) ** 2 - (y / HEAD[1]) ** 2, 0));
    return this.project([x, y, z - out]);
  }

  drawBust(context, palette) {
    const fade = context.createLinearGradient(0, 0.9, 0, 2.1);
    fade.addColorStop(0, palette.torso);
    fade.addColorStop(1, palette.torsoEnd);
    context.fillStyle = fade;
    context.beginPath();
    context.moveTo(-0.34, 0.6);
    context.bezierCurveTo(-0.34, 1.25, -0.5, 1.3, -1.0, 1.42);
    context.bezierCurveTo(-1.45, 1.52, -1.6, 1.75, -1.66, 2.1);
    context.lineTo(1.66, 2.1);
    context.bezierCurveTo(1.6, 1.75, 1.45, 1.52, 1.0, 1.42);
    context.bezierCurveTo(0.5, 1.3, 0.34, 1.25, 0.34, 0.6);
    context.fill();
  }

  // The outline of a turned ellipsoid is an ellipse: that of the matrix R diag(axes^2) R'.
  drawSkull(context, matrix, palette) {
    const entry = (i, j) => HEAD.reduce((sum, axis, k) => sum + matrix[i][k] * matrix[j][k] * axis * axis, 0);
    const [xx, xy, yy] = [entry(0, 0), entry(0, 1), entry(1, 1)];
    const spread = Math.hypot((xx - yy) / 2, xy), angle = Math.atan2(2 * xy, xx - yy) / 2;
    const mean = (xx + yy) / 2;
    context.lineWidth = 0.04;
    context.strokeStyle = palette.body;
    context.fillStyle = palette.skin;
    for (const side of [-1, 1]) {
      const [x, y] = this.project([side * HEAD[0], -0.02, 0.1]);
      context.beginPath();
      context.ellipse(x, y, 0.1, 0.17, 0, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
    context.beginPath();
    context.ellipse(0, 0, Math.sqrt(mean + spread), Math.sqrt(mean - spread), angle, 0, 2 * Math.PI);
    context.fill();
    context.save();
    context.clip();
    this.drawHair(context, palette);
    context.restore();
    context.beginPath();
    context.ellipse(0, 0, Math.sqrt(mean + spread), Math.sqrt(mean - spread), angle, 0, 2 * Math.PI);
    context.stroke();
  }

  drawHair(context, palette) {
    const line = range(-8, 9).map((i) => this.surface(0.095 * i, -0.62 + 0.1 * (i / 8) ** 2 * 3));
    smooth(context, line);
    context.lineTo(line[16][0] + 1, line[16][1] - 0.2);
    context.lineTo(1.6, -1.8);
    context.lineTo(-1.6, -1.8);
    context.lineTo(line[0][0] - 1, line[0][1] - 0.2);
    context.closePath();
    context.fillStyle = palette.hair;
    context.fill();
  }

  drawCheeks(context, unit, palette) {
    context.fillStyle = context.strokeStyle = palette.cheek;
    for (const side of [-1, 1]) {
      const raised = unit("AU06"), y = 0.26 - 0.08 * raised;
      const rim = range(0, 16).map((i) => {
        const angle = i * Math.PI / 8;
        return this.surface(side * 0.4 + 0.15 * Math.cos(angle), y + 0.1 * Math.sin(angle));
      });
      context.globalAlpha = 0.1 + 0.6 * raised;
      smooth(context, rim, true);
      context.fill();
      context.globalAlpha = 1;
    }
  }

  drawEye(context, side, unit, palette) {
    const wide = 0.155, y = -0.12;
    const up = 0.085 + 0.075 * unit("AU05") - 0.045 * unit("AU07");
    const down = Math.max(0.06 - 0.045 * unit("AU06") - 0.03 * unit("AU07"), 0.004);
    const lid = (height) => range(-4, 5).map((i) => {
      const x = i / 4;
      return this.surface(side * 0.3 + wide * x, y - height * (1 - x * x));
    });
    const upper = lid(Math.max(up, 0.02)), lower = lid(-down);
    smooth(context, upper);
    for (const point of lower.reverse()) context.lineTo(...point);
    context.closePath();
    context.fillStyle = palette.eye;
    context.fill();
    context.save();
    context.clip();
    context.fillStyle = palette.pupil;
    disc(context, this.surface(side * 0.3, y - 0.015), 0.075);
    context.fillStyle = palette.eye;
    disc(context, this.surface(side * 0.3 + 0.025, y - 0.045), 0.02);
    context.restore();
    context.strokeStyle = palette.body;
    context.lineWidth = 0.035;
    smooth(context, upper);
    context.stroke();
    context.lineWidth = 0.018;
    smooth(context, lower);
    context.stroke();
  }

  drawBrow(context, side, unit, palette) {
    const inner = unit("AU01"), outer = unit("AU02"), lowered = unit("AU04");
    const line = range(0, 6).map((i) => {
      const share = i / 5;  // 0 inside, 1 outside
      const lift = 0.2 * inner * (1 - share) ** 1.5 + 0.17 * outer * share ** 1.2 * (1.5 - 0.5 * share);
      const x = 0.15 + 0.34 * share - 0.06 * lowered * (1 - share);
      const arch = -0.055 * Math.sin(Math.PI * Math.min(share * 1.15, 1));
      return this.surface(side * x, -0.33 + arch - lift + 0.13 * lowered * (1 - 0.55 * share));
    });
    context.strokeStyle = palette.brow;
    context.lineWidth = 0.07;
    smooth(context, line);
    context.stroke();
    if (lowered > 0.1) {
      context.globalAlpha = Math.min(lowered, 0.8);
      context.lineWidth = 0.02;
      smooth(context, [this.surface(side * 0.05, -0.36), this.surface(side * 0.045, -0.24)]);
      context.stroke();
      context.globalAlpha = 1;
    }
  }

  drawNoseAndMouth(context, unit, palette) {
    context.strokeStyle = palette.body;
    context.lineWidth = 0.028;
    smooth(context, [this.surface(0.0, -0.06, 0.05), this.surface(-0.015, 0.12, 0.16),
                     this.surface(-0.01, 0.22, 0.2), this.surface(0.07, 0.26, 0.08)]);
    context.stroke();
    const lift = 0.03 * unit("AU06");
    context.lineWidth = 0.034;
    smooth(context, range(-3, 4).map((i) => this.surface(0.075 * i, 0.53 - (lift + 0.012) * (i / 3) ** 2)));
    context.stroke();
  }
}
