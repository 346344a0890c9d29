// Videos, where ffmpeg is there; ffprobe says what is in them.
#include "models/player/video.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/player/show_data.h"

namespace gestus::player {
namespace {

/// What a program prints.
std::string Output(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

TEST(VideoTest, HasThePicturesAndTheSound) {
  if (!FindFfmpeg().ok()) GTEST_SKIP() << "no ffmpeg";
  Show show = test::BodyShow(30);  // 2 s
  show.sound = test::Tone(2);
  const Result<std::string> video = MakeVideo(show, {.width = 320, .height = 180, .rate = 10});
  ASSERT_TRUE(video.ok()) << video.status().message();
  char path[] = "/tmp/gestus-video-XXXXXX";
  const int fd = ::mkstemp(path);
  ASSERT_EQ(::write(fd, video->data(), video->size()), static_cast<ssize_t>(video->size()));
  ::close(fd);
  const std::string said = Output(
      "ffprobe -v error -count_frames -show_entries "
      "stream=codec_name,width,height,nb_read_frames,duration -of default=nw=1 " +
      std::string(path));
  ::unlink(path);
  for (const char* line : {"codec_name=h264", "codec_name=aac", "width=320", "height=180",
                           "nb_read_frames=20", "duration=2.000000"})
    EXPECT_NE(said.find(line), std::string::npos) << line << " in\n" << said;
}

TEST(VideoTest, WithoutFfmpegIsOneLine) {
  const char* path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  ASSERT_EQ(::setenv("PATH", "/nonexistent", 1), 0);
  const Result<std::string> video = MakeVideo(test::BodyShow(2), {});
  const Status found = FindFfmpeg();
  ::setenv("PATH", before.c_str(), 1);
  ASSERT_FALSE(video.ok());
  EXPECT_NE(video.status().message().find("ffmpeg was not found"), std::string::npos);
  EXPECT_FALSE(found.ok());
}

TEST(VideoTest, WhatFfmpegRefusesIsSaid) {
  // A program of that name that reads nothing and complains.
  char folder[] = "/tmp/gestus-ffmpeg-XXXXXX";
  ASSERT_NE(::mkdtemp(folder), nullptr);
  const std::string fake = std::string(folder) + "/ffmpeg";
  std::FILE* file = std::fopen(fake.c_str(), "w");
  std::fputs("#!/bin/sh\necho first >&2\necho 'no such encoder' >&2\nexit 3\n", file);
  std::fclose(file);
  ASSERT_EQ(::chmod(fake.c_str(), 0755), 0);
  const std::string before = std::getenv("PATH");
  ::setenv("PATH", (std::string(folder) + ":" + before).c_str(), 1);
  const Result<std::string> video = MakeVideo(test::BodyShow(60), {.width = 640, .height = 360});
  ::setenv("PATH", before.c_str(), 1);
  ::unlink(fake.c_str());
  ::rmdir(folder);
  ASSERT_FALSE(video.ok());
  EXPECT_EQ(video.status().message(), "ffmpeg failed and said: no such encoder");
}

TEST(VideoTest, SizesAreChecked) {
  EXPECT_FALSE(MakeVideo(test::BodyShow(2), {.width = 321, .height = 180}).ok());
  EXPECT_FALSE(MakeVideo(test::BodyShow(2), {.width = 320, .height = 180, .rate = 0}).ok());
}

}  // namespace
}  // namespace gestus::player
