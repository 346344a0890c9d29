// The data of the page as JSON, and the page around it.
#include "models/player/page.h"

#include <algorithm>
#include <cmath>

#include "models/io/text.h"
#include "models/player/page_files.h"
#include "models/player/quantise.h"
#include "models/player/text.h"
#include "models/player/wav.h"

namespace gestus::player {
namespace {

using outputs::Curves;
using outputs::Figure;
using outputs::Motion;
using outputs::Point;

void WriteFigure(const Figure& figure, bool body, ScriptJson* json) {
  const Quantised quantised = Quantise(DrawnValues(figure, body));
  json->BeginObject().Key("names").BeginArray();
  for (const Point& point : figure.points) json->Text(point.name);
  json->EndArray().Key("parents").BeginArray();
  for (const Point& point : figure.points) json->Integer(point.parent);
  json->EndArray().Key("sources").BeginArray();
  for (const Point& point : figure.points) json->Integer(point.source);
  json->EndArray().Key("offset").Exact(quantised.offset).Key("scale").Exact(quantised.scale);
  json->Key("numbers").Packed(quantised.numbers).EndObject();
}

/// Each curve by itself: (curves, frames).
void WriteCurves(const Curves& curves, ScriptJson* json) {
  const std::size_t count = curves.curves.size();
  const std::vector<float> values = Finite(curves.values, count);
  json->BeginArray();
  for (std::size_t n = 0; n < count; ++n) {
    std::vector<float> column;
    for (std::size_t i = n; i < values.size(); i += count) column.push_back(values[i]);
    const Quantised quantised = Quantise(column);
    const outputs::Curve& curve = curves.curves[n];
    json->BeginObject().Key("name").Text(curve.name).Key("unit").Text(curve.unit);
    json->Key("minimum").Number(curve.minimum).Key("maximum").Number(curve.maximum);
    json->Key("offset").Exact(quantised.offset).Key("scale").Exact(quantised.scale);
    json->Key("numbers").Packed(quantised.numbers).EndObject();
  }
  json->EndArray();
}

void WriteTake(const Take& take, ScriptJson* json) {
  const Motion& motion = *take.motion;
  json->BeginObject().Key("role").Text(take.role).Key("rate").Exact(motion.frame_rate);
  json->Key("frames").Integer(motion.frames).Key("normalised").Flag(motion.normalised);
  json->Key("seams").BeginArray();
  for (const std::int64_t seam : motion.seams) json->Integer(seam);
  json->EndArray();
  if (motion.body) WriteFigure(*motion.body, true, &json->Key("body"));
  if (motion.face) WriteFigure(*motion.face, false, &json->Key("face"));
  if (motion.curves) WriteCurves(*motion.curves, &json->Key("curves"));
  json->EndObject();
}

void WriteSpeech(const Show& show, ScriptJson* json) {
  if (!show.sound.samples.empty()) {
    const Levels levels = LevelsOf(show.sound);
    json->Key("levels").BeginObject().Key("rate").Integer(Levels::kRate);
    json->Key("peak").Packed(levels.peak).Key("rms").Packed(levels.rms).EndObject();
  }
  if (const Picture picture = PictureOf(show.spectrogram); !picture.values.empty()) {
    json->Key("spectrogram").BeginObject().Key("rate").Exact(picture.rate);
    json->Key("bins").Integer(picture.bins).Key("values").Packed(picture.values).EndObject();
  }
  if (!show.pitch.hz.empty()) {
    std::vector<std::int16_t> tenths;
    for (const float hz : show.pitch.hz)
      tenths.push_back(static_cast<std::int16_t>(
          std::isfinite(hz) ? std::lround(10 * std::clamp(hz, 0.0f, 3000.0f)) : 0));
    json->Key("pitch").BeginObject().Key("rate").Exact(show.pitch.rate);
    json->Key("tenths").Packed(tenths).EndObject();
  }
  json->Key("words").BeginArray();
  for (const words::Word& word : show.words)
    json->BeginArray().Text(word.text).Number(word.start).Number(word.end).EndArray();
  json->EndArray();
}

std::string DataOf(const Show& show) {
  ScriptJson json;
  json.BeginObject().Key("title").Text(show.title).Key("network").Text(show.network);
  json.Key("weights").Text(show.weights).Key("trained").Flag(show.trained);
  json.Key("seconds").Exact(show.seconds()).Key("takes").BeginArray();
  for (const Take& take : TakesOf(show)) WriteTake(take, &json);
  json.EndArray();
  WriteSpeech(show, &json);
  json.EndObject();
  return json.text();
}

/// The <audio> element's source; empty: no sound.
std::string SoundOf(const Show& show, std::vector<std::string>* notes) {
  const Sound& sound = show.sound;
  if (sound.samples.empty()) return "";
  if (sound.seconds() > kMaxSoundSeconds) {
    notes->push_back("page: without sound, which is " + Fixed(sound.seconds(), 0) +
                     " s long; a page holds " + Fixed(kMaxSoundSeconds, 0) + " s");
    return "";
  }
  const bool plain = sound.file.size() <= kMaxPlainWav && IsPlainWav(sound.file);
  return "data:audio/wav;base64," +
         Base64(plain ? sound.file : MakeWav(sound.samples, sound.sample_rate));
}

}  // namespace

Result<std::string> MakePage(const Show& show, std::vector<std::string>* notes) {
  GESTUS_RETURN_IF_ERROR(CheckShow(show));
  const std::string data = DataOf(show), sound = SoundOf(show, notes), title = Escaped(show.title);
  const auto value = [&](std::string_view name) -> std::string_view {
    if (name == "title") return title;
    if (name == "style") return kPageStyle;
    if (name == "script") return kPageScript;
    if (name == "data") return data;
    return sound;
  };
  std::string page;
  page.reserve(kPageHtml.size() + kPageStyle.size() + kPageScript.size() + data.size() +
               sound.size());
  // What is put in is not looked at again, so that it may hold {{anything}}.
  std::string_view rest = kPageHtml;
  for (std::size_t at; (at = rest.find("{{")) != std::string_view::npos;) {
    const std::size_t end = rest.find("}}", at);
    page += rest.substr(0, at);
    page += value(rest.substr(at + 2, end - at - 2));
    rest.remove_prefix(end + 2);
  }
  page += rest;
  return page;
}

}  // namespace gestus::player
