#include "models/words/frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/io/text.h"

namespace gestus::words {
namespace {

// An hour at 15 frames a second has 54,000; what is beyond is a mistake, and would not fit memory.
constexpr std::size_t kMaxFrames = std::size_t{1} << 28;

Status CheckOptions(std::size_t words, std::size_t pieces, const FrameOptions& options) {
  if (words != pieces) {
    return Status(Code::kInvalidArgument, "there are numbers of pieces for " +
                                              Count(pieces, "word") + ", expected " +
                                              std::to_string(words));
  }
  if (!std::isfinite(options.start) || !(options.rate > 0) || !std::isfinite(options.rate)) {
    return Status(Code::kInvalidArgument, "the interval begins at " +
                                              Significant(options.start, 6) + " s and has " +
                                              Significant(options.rate, 6) +
                                              " frames a second, expected finite numbers and a "
                                              "rate above 0");
  }
  if (options.frames > kMaxFrames || words > std::numeric_limits<std::int32_t>::max()) {
    return Status(Code::kInvalidArgument, Count(options.frames, "frame") + " for " +
                                              Count(words, "word") + ", expected at most " +
                                              Grouped(kMaxFrames) + " frames");
  }
  return Status();
}

bool IsInside(const Word& word, const FrameOptions& options) {
  const double end = options.start + static_cast<double>(options.frames) / options.rate;
  if (options.by_end) return word.end > options.start && word.end <= end;
  // A word without length may be all that is known of it.
  return word.start < end &&
         (word.end > options.start || (word.start == word.end && word.start >= options.start));
}

// int() of Python: towards 0.
std::size_t StartFrame(const Word& word, const FrameOptions& options) {
  const double frame = std::trunc((word.start - options.start) * options.rate);
  const auto length = static_cast<double>(options.frames);
  return static_cast<std::size_t>(std::clamp(frame, 0.0, length));
}

void FillPieces(const WordFrames& at, std::size_t pieces, std::vector<FramePiece>* frames) {
  const std::size_t each = (at.end - at.begin) / pieces;
  for (std::size_t f = at.begin; f < at.end; ++f) {
    const std::size_t piece = each == 0 ? pieces - 1 : std::min((f - at.begin) / each, pieces - 1);
    (*frames)[f] = {static_cast<std::int32_t>(at.word), static_cast<std::int32_t>(piece)};
  }
}

}  // namespace

Result<FramePlan> PlaceOnFrames(const std::vector<Word>& words,
                                const std::vector<std::size_t>& pieces,
                                const FrameOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckOptions(words.size(), pieces.size(), options));
  FramePlan plan;
  plan.frames.resize(options.frames);
  std::size_t outside = 0, empty = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!IsInside(words[i], options)) {
      ++outside;
    } else if (pieces[i] == 0) {
      ++empty;
    } else {
      // A word never begins before the one in front of it, whatever order they came in.
      const std::size_t least = plan.words.empty() ? 0 : plan.words.back().begin;
      const std::size_t begin = plan.words.empty() ? 0 : StartFrame(words[i], options);
      plan.words.push_back({i, std::max(least, begin), options.frames});
    }
  }
  for (std::size_t i = 0; i < plan.words.size(); ++i) {
    if (i + 1 < plan.words.size()) plan.words[i].end = plan.words[i + 1].begin;
    FillPieces(plan.words[i], pieces[plan.words[i].word], &plan.frames);
  }
  if (outside > 0) {
    const double end = options.start + static_cast<double>(options.frames) / options.rate;
    plan.notes.push_back(Count(outside, "word") + " outside of " + Fixed(options.start, 2) +
                         " to " + Fixed(end, 2) + " s left out");
  }
  if (empty > 0) plan.notes.push_back(Count(empty, "word") + " without any token left out");
  return plan;
}

}  // namespace gestus::words
