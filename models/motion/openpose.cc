#include "models/motion/openpose.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "models/io/reading.h"
#include "models/io/text.h"
#include "models/motion/joints.h"
#include "models/motion/openpose_frame.h"

namespace gestus::motion {
namespace {

constexpr std::string_view kEnd = "_keypoints.json";

struct FrameFile {
  std::int64_t number = 0;
  std::string path;
};

// "talk_000000000012_keypoints.json" to 12 and, in `before`, "talk_".
Result<std::int64_t> FrameNumber(std::string_view name, std::string* before) {
  std::string_view digits = name.substr(0, name.size() - kEnd.size());
  const std::size_t last_other = digits.find_last_not_of("0123456789");
  const std::size_t begin = last_other == std::string_view::npos ? 0 : last_other + 1;
  *before = std::string(digits.substr(0, begin));
  digits.remove_prefix(begin);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    return BadInput(std::string(name) + ": no frame number before " + std::string(kEnd) +
                    ", expected names like talk_000000000012_keypoints.json");
  }
  return number;
}

// The files of a folder in the order of their numbers.
Result<std::vector<FrameFile>> ListFrames(const std::string& folder,
                                          const OpenPoseOptions& options) {
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  std::vector<FrameFile> files;
  std::string clip, clip_of;  // what stands before the numbers, and in which name
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.ends_with(kEnd)) continue;
    std::string before;
    const Result<std::int64_t> number = FrameNumber(name, &before);
    if (!number.ok()) return number.status();
    if (files.empty()) {
      clip = before;
      clip_of = name;
    } else if (before != clip) {
      return BadInput("holds " + std::min(name, clip_of) + " and " + std::max(name, clip_of) +
                      ", expected the frames of one clip");
    }
    if (std::ssize(files) == options.max_frames) {
      return Status(Code::kResourceExhausted,
                    "holds more than " +
                        Count(static_cast<std::uint64_t>(options.max_frames), "frame") +
                        ", expected at most as many");
    }
    files.push_back({*number, entry->path().string()});
  }
  if (error) return Status(Code::kIo, "cannot be read (" + error.message() + ")");
  if (files.empty()) {
    return BadInput("holds no file named *<number>_keypoints.json, expected OpenPose's frames");
  }
  std::sort(files.begin(), files.end(), [](const FrameFile& a, const FrameFile& b) {
    return std::tie(a.number, a.path) < std::tie(b.number, b.path);
  });
  for (std::size_t i = 1; i < files.size(); ++i) {
    if (files[i].number == files[i - 1].number) {
      return BadInput("frame " + std::to_string(files[i].number) +
                      " is there twice, expected once");
    }
  }
  return files;
}

void Store(std::span<const Point> points, std::int64_t frame, Track* track) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto at = static_cast<std::int64_t>(p);
    track->value(frame, 0, at) = points[p].x;
    track->value(frame, 1, at) = points[p].y;
    track->seen(frame, at) = points[p].confidence;
  }
}

// What the notes tell.
struct Tally {
  std::int64_t nobody = 0, several = 0, too_far = 0, null_points = 0;
};

Status ReadFrames(const std::vector<FrameFile>& files, const OpenPoseOptions& options,
                  OpenPoseClip* clip, Tally* tally) {
  PersonChooser chooser;
  std::size_t next = 0;
  for (std::int64_t t = 0; t < clip->body.frames; ++t) {
    OpenPoseFrame frame;
    if (files[next].number - files.front().number == t) {
      const FrameFile& file = files[next++];
      const Result<std::string> text = ReadFile(file.path, options.max_file_bytes);
      if (!text.ok()) return text.status();
      Result<OpenPoseFrame> read = ParseOpenPose(*text);
      if (!read.ok()) return read.status().In(file.path);
      frame = *std::move(read);
      tally->nobody += frame.people.empty();
    }
    tally->several += frame.people.size() > 1;
    tally->null_points += frame.null_points;
    const Person* person = chooser.Choose(frame.people);
    tally->too_far += person == nullptr && !frame.people.empty();
    if (person == nullptr) continue;
    Store(person->body, t, &clip->body);
    Store(person->face, t, &clip->face);
  }
  return Status();
}

// Without OpenPose's --hand the wrist is the nearest that there is.
void TakeHandRootsFromWrists(OpenPoseClip* clip) {
  Track& body = clip->body;
  for (const auto& [root, wrist] :
       {std::pair(kLHandRoot, kLWrist), std::pair(kRHandRoot, kRWrist)}) {
    if (body.Has(root) || !body.Has(wrist)) continue;
    for (std::int64_t t = 0; t < body.frames; ++t) {
      body.value(t, 0, root) = body.value(t, 0, wrist);
      body.value(t, 1, root) = body.value(t, 1, wrist);
      body.seen(t, root) = body.seen(t, wrist);
    }
    clip->notes.push_back("no frame has " + body.points[static_cast<std::size_t>(root)] +
                          ": it is taken from the wrist");
  }
}

bool InUnitSquare(const Track& track) {
  return std::all_of(track.values.begin(), track.values.end(),
                     [](float v) { return std::fabs(v) <= 1; });
}

void Describe(const Tally& tally, std::int64_t first, std::int64_t present, OpenPoseClip* clip) {
  const auto note = [&](std::int64_t n, const std::string& what, const std::string& text) {
    if (n > 0) clip->notes.push_back(Count(static_cast<std::uint64_t>(n), what) + text);
  };
  if (first > 1) {
    clip->notes.push_back("the first frame has number " + std::to_string(first) +
                          ", which is taken as the start");
  }
  note(clip->body.frames - present, "frame", " without a file: taken as lost");
  note(tally.nobody, "frame", " without people: taken as lost");
  note(tally.several, "frame",
       " with several people: the one is kept that is found best at first, and followed");
  note(tally.too_far, "frame", " in which only others are seen, too far away: taken as lost");
  note(tally.null_points, "point", " given as null: taken as lost");
  if (InUnitSquare(clip->body)) {
    clip->notes.push_back(
        "all coordinates lie within -1 to 1 (keypoint_scale of OpenPose?), but pixels are "
        "expected");
  }
}

}  // namespace

Result<OpenPoseClip> ReadOpenPose(const std::string& path, const OpenPoseOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckFrameRate(options.frame_rate, "the frame rate"));
  std::vector<FrameFile> files = {{0, path}};
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    Result<std::vector<FrameFile>> listed = ListFrames(path, options);
    if (!listed.ok()) return listed.status().In(path);
    files = *std::move(listed);
  }
  const Result<std::int64_t> frames =
      CountFrames(files.front().number, files.back().number, std::ssize(files), options.max_frames);
  if (!frames.ok()) return frames.status().In(path);

  OpenPoseClip clip;
  clip.body = Track(PatsJointNames(), 2, *frames, options.frame_rate);
  clip.face = Track(FacePointNames(), 2, *frames, options.frame_rate);
  Tally tally;
  GESTUS_RETURN_IF_ERROR(ReadFrames(files, options, &clip, &tally));
  const auto seen = [](const Track& track) {
    return std::any_of(track.confidence.begin(), track.confidence.end(),
                       [](float c) { return c > 0; });
  };
  if (!seen(clip.body)) {
    return BadInput(path + ": nobody in any of " +
                    Count(static_cast<std::uint64_t>(*frames), "frame") +
                    ", expected a person with a body");
  }
  if (!seen(clip.face)) {
    clip.face = Track();
    clip.notes.push_back("no frame has points of a face");
  }
  TakeHandRootsFromWrists(&clip);
  Describe(tally, files.front().number, std::ssize(files), &clip);
  return clip;
}

}  // namespace gestus::motion
