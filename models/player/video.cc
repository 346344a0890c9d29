// ffmpeg reads pictures from its standard input, a socket, so that one that ends early is an error
// of a call and no signal; sound and result go through files without a name, so that nothing is
// left behind whatever happens.
#include "models/player/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "models/io/file.h"
#include "models/io/text.h"
#include "models/player/pictures.h"
#include "models/player/wav.h"

extern char** environ;

namespace gestus::player {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
/// A file without a name.
using Scratch = std::unique_ptr<std::FILE, CloseFile>;

Status SystemError(const std::string& what, int error) {
  return Status(Code::kIo, what + ": " + std::strerror(error));
}

Status NotFound() {
  return Status(
      Code::kNotFound,
      "the program ffmpeg was not found, expected it on the PATH (Debian: apt install ffmpeg)");
}

Result<Scratch> MakeScratch() {
  Scratch file(std::tmpfile());
  if (file == nullptr) return SystemError("a temporary file cannot be made", errno);
  return file;
}

Result<std::string> ReadAll(std::FILE* file) {
  std::rewind(file);
  std::string bytes;
  char piece[65536];
  for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, file)) > 0;) bytes.append(piece, n);
  if (std::ferror(file) != 0) return SystemError("a temporary file cannot be read", errno);
  return bytes;
}

/// A program whose standard input and further files are ours.
class Program {
 public:
  /// `files` become its descriptors 3, 4, ...; what it says goes to `said`.
  static Result<Program> Start(std::vector<std::string> arguments,
                               const std::vector<std::FILE*>& files, std::FILE* said) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      return SystemError("a socket cannot be made", errno);
    Program program;
    program.input_ = Descriptor(ends[0]);
    const Descriptor theirs(ends[1]);
    std::vector<int> wanted = {theirs.get(), ::fileno(said), ::fileno(said)};
    for (std::FILE* file : files) wanted.push_back(::fileno(file));
    // Copies with high numbers: none stands where another is to go.
    std::vector<Descriptor> copies;
    for (const int fd : wanted) {
      copies.emplace_back(::fcntl(fd, F_DUPFD_CLOEXEC, 64));
      if (copies.back().get() < 0) return SystemError("no more files can be opened", errno);
    }
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (std::size_t i = 0; i < copies.size(); ++i)
      ::posix_spawn_file_actions_adddup2(&actions, copies[i].get(), static_cast<int>(i));
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const int error =
        ::posix_spawnp(&program.pid_, argv[0], &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error == ENOENT || error == ENOTDIR || error == EACCES) return NotFound();
    if (error != 0) return SystemError(arguments[0] + " cannot be run", error);
    return program;
  }

  Program(Program&& other) noexcept
      : input_(std::move(other.input_)), pid_(std::exchange(other.pid_, -1)) {}
  Program& operator=(Program&&) = delete;
  ~Program() { (void)Finish(); }

  /// False when it no longer listens.
  bool Write(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::send(input_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
  }

  /// Waits for its end; gives its exit status, or -1 when a signal ended it.
  int Finish() {
    input_ = Descriptor();
    if (pid_ < 0) return -1;
    int status = -1;
    while (::waitpid(pid_, &status, 0) < 0) {
      if (errno != EINTR) break;
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  Program() = default;

  Descriptor input_;
  pid_t pid_ = -1;
};

/// What a child exits with when its program could not be started and posix_spawnp did not learn of
/// it (POSIX allows that; qemu-user does so).
constexpr int kNoSuchProgram = 127;

std::string LastLine(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \r\n");
  if (end == std::string::npos) return "nothing";
  const std::size_t begin = text.find_last_of("\r\n", end);
  return OneLine(text.substr(begin + 1, end - begin), 120);  // npos + 1 is 0
}

std::vector<std::string> Command(const VideoOptions& options, bool sound) {
  std::vector<std::string> command = {
      "ffmpeg",
      "-nostdin",
      "-hide_banner",
      "-loglevel",
      "error",
      "-f",
      "rawvideo",
      "-pix_fmt",
      "rgb24",
      "-video_size",
      std::to_string(options.width) + "x" + std::to_string(options.height),
      "-framerate",
      Significant(options.rate, 8),
      "-i",
      "pipe:0"};
  const auto add = [&](std::initializer_list<const char*> more) {
    command.insert(command.end(), more.begin(), more.end());
  };
  // The files are named by their descriptors: MP4 must seek in what it writes.
  if (sound) add({"-f", "wav", "-i", "/dev/fd/4", "-c:a", "aac", "-b:a", "128k"});
  add({"-c:v", "libx264", "-preset", "fast", "-crf", "18", "-pix_fmt", "yuv420p", "-movflags",
       "+faststart", "-f", "mp4", "-y", "/dev/fd/3"});
  return command;
}

}  // namespace

Status FindFfmpeg() {
  const Result<Scratch> said = MakeScratch();
  if (!said.ok()) return said.status();
  Result<Program> program = Program::Start({"ffmpeg", "-version"}, {}, said->get());
  if (!program.ok()) return program.status();
  const int status = program->Finish();
  if (status == 0) return Status();
  if (status == kNoSuchProgram) return NotFound();
  return Status(Code::kNotFound, "the program ffmpeg cannot be run, expected that of ffmpeg.org");
}

Result<std::string> MakeVideo(const Show& show, const VideoOptions& options) {
  GESTUS_RETURN_IF_ERROR(CheckShow(show));
  const auto even = [](int n) { return n >= 64 && n <= 8192 && n % 2 == 0; };
  if (!even(options.width) || !even(options.height) || !(options.rate >= 1 && options.rate <= 240))
    return Status(Code::kInvalidArgument,
                  "video: expected even sizes of 64 to 8192 pixels and 1 to 240 pictures a second");
  Result<Scratch> video = MakeScratch(), said = MakeScratch(), sound = MakeScratch();
  for (const Result<Scratch>* file : {&video, &said, &sound})
    if (!file->ok()) return file->status();
  const bool audible = !show.sound.samples.empty();
  if (audible) {
    const std::string wav = MakeWav(show.sound.samples, show.sound.sample_rate);
    if (std::fwrite(wav.data(), 1, wav.size(), sound->get()) != wav.size() ||
        std::fflush(sound->get()) != 0)
      return SystemError("a temporary file cannot be written", errno);
  }
  Result<Program> ffmpeg =
      Program::Start(Command(options, audible), {video->get(), sound->get()}, said->get());
  if (!ffmpeg.ok()) return ffmpeg.status();
  Pictures pictures(show, options.width, options.height);
  const auto count =
      static_cast<std::int64_t>(std::max(1.0, std::ceil(show.seconds() * options.rate - 1e-6)));
  bool listens = true;
  for (std::int64_t i = 0; listens && i < count; ++i)
    listens = ffmpeg->Write(pictures.At(static_cast<double>(i) / options.rate).bytes());
  const int status = ffmpeg->Finish();
  if (status == kNoSuchProgram) return NotFound();
  if (status != 0 || !listens) {
    const Result<std::string> text = ReadAll(said->get());
    return Status(Code::kIo, "ffmpeg failed and said: " + LastLine(text.ok() ? *text : ""));
  }
  return ReadAll(video->get());
}

}  // namespace gestus::player
