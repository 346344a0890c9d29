// The time that is shown: that of the sound while there is some, else that of the wall.

class Clock {
  constructor(sound, seconds) {
    this.sound = sound.getAttribute("src") ? sound : null;
    this.seconds = seconds;
    this.playing = false;
    this.rate = 1;
    this.shown = 0;
    this.heard = { time: 0, at: 0 };  // the last new time of the sound, and when it came
    this.wall = { time: 0, at: 0 };
    this.complaint = "";
  }

  // Where the sound ends, motion may go on.
  get soundSeconds() {
    return this.sound && Number.isFinite(this.sound.duration) ? this.sound.duration : 0;
  }

  get audible() {
    return this.sound !== null && this.shown < this.soundSeconds - 0.005;
  }

  async play() {
    if (this.playing) return;
    if (this.shown >= this.seconds - 0.005) this.seek(0);
    this.playing = true;
    await this.startSound();
  }

  async startSound() {
    const now = performance.now();
    this.wall = { time: this.shown, at: now };
    this.heard = { time: this.shown, at: now };
    if (!this.audible) return;
    this.sound.playbackRate = this.rate;
    try {
      await this.sound.play();
    } catch (error) {
      if (error.name === "AbortError") return;  // paused before it began
      this.playing = false;
      this.complaint = "The browser does not play the sound: " + error.message;
    }
  }

  pause() {
    this.playing = false;
    if (this.sound) this.sound.pause();
  }

  seek(time) {
    this.shown = Math.min(Math.max(time, 0), this.seconds);
    const now = performance.now();
    this.wall = { time: this.shown, at: now };
    this.heard = { time: this.shown, at: now };
    if (!this.sound) return;
    this.sound.currentTime = Math.min(this.shown, this.soundSeconds || this.shown);
    if (this.playing && this.audible && this.sound.paused) this.startSound();
  }

  setRate(rate) {
    this.wall = { time: this.shown, at: performance.now() };
    this.rate = rate;
    if (this.sound) this.sound.playbackRate = rate;
  }

  // Moves on to `now` (of performance.now) and returns the time to show.
  tick(now) {
    if (!this.playing) return this.shown;
    this.shown = this.sound && !this.sound.paused && !this.sound.ended && this.soundSeconds > 0
      ? this.soundTime(now) : this.wallTime(now);
    if (this.shown >= this.seconds) {
      this.shown = this.seconds;
      this.pause();
    }
    return this.shown;
  }

  // Browsers move currentTime on in steps, which a moment of the wall's time fills in.
  soundTime(now) {
    const time = this.sound.currentTime;
    if (time !== this.heard.time) this.heard = { time, at: now };
    const since = Math.min(Math.max(now - this.heard.at, 0) / 1000, 0.05) * this.rate;
    this.wall = { time: time + since, at: now };
    return Math.min(time + since, this.soundSeconds);
  }

  wallTime(now) {
    if (this.audible && !this.sound.ended) {  // the sound is about to start
      this.wall = { time: this.shown, at: now };
      return this.shown;
    }
    return this.wall.time + Math.max(now - this.wall.at, 0) / 1000 * this.rate;
  }
}
