// The words around the time shown, the one that is spoken marked.

// Begins of phrases: after a pause of half a second, or when a line would become too long.
function phrasesOf(words) {
  const begins = [];
  let letters = 0;
  words.forEach(([text, start], i) => {
    const pause = i === 0 || start - words[i - 1][2] > 0.5;
    if (pause || letters + text.length > 64) {
      begins.push(i);
      letters = 0;
    }
    letters += text.length + 1;
  });
  return begins;
}

class Caption {
  constructor(paragraph, words, onSeek) {
    this.paragraph = paragraph;
    this.words = words;
    this.begins = phrasesOf(words);
    this.phrase = this.word = -1;
    paragraph.hidden = words.length === 0;
    paragraph.addEventListener("click", (event) => {
      const span = event.target.closest("[data-word]");
      if (span) onSeek(words[Number(span.dataset.word)][1]);
    });
  }

  show(time) {
    if (this.words.length === 0) return;
    // The last word that has begun; before the first, the first.
    let last = 0;
    const spoken = wordAt(this.words, time);
    if (spoken >= 0) last = spoken;
    else while (last + 1 < this.words.length && this.words[last + 1][1] <= time) ++last;
    const phrase = this.begins.findLastIndex((begin) => begin <= last);
    if (phrase !== this.phrase) this.fill(phrase);
    if (spoken === this.word) return;
    for (const span of this.paragraph.children)
      span.classList.toggle("now", Number(span.dataset.word) === spoken);
    this.word = spoken;
  }

  fill(phrase) {
    this.phrase = phrase;
    this.word = -1;
    const end = this.begins[phrase + 1] ?? this.words.length;
    this.paragraph.replaceChildren();
    for (let i = this.begins[phrase]; i < end; ++i) {
      const span = document.createElement("bdi");
      span.dataset.word = i;
      span.textContent = this.words[i][0];
      this.paragraph.append(span, " ");
    }
  }
}
