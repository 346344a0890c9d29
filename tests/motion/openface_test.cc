// OpenFace's CSV: headers of all versions, faces, frame rates, gaps and damage.
#include "models/motion/openface.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/motion/motion_data.h"

namespace gestus::motion {
namespace {

class OpenFaceTest : public testing::Test {
 protected:
  Result<OpenFaceClip> Read(const std::string& text, const OpenFaceOptions& options = {}) {
    return ReadOpenFace(folder_.Write("face.csv", text), options);
  }
  std::string Error(const std::string& text, const OpenFaceOptions& options = {}) {
    const std::string path = folder_.path() + "/face.csv: ";
    const std::string message = Read(text, options).status().message();
    return message.starts_with(path) ? message.substr(path.size()) : message;
  }

  TempFolder folder_;
};

std::string Joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += note + "\n";
  return text;
}

TEST_F(OpenFaceTest, FindsColumnsByTrimmedName) {
  const std::string rows = "3, 0.08, 0.97, 1, 0.25, -1.5e-1, 9\n4, 0.12, 0.90, 1, .5, 0.1, 9\n";
  for (const std::string header :
       {"frame, timestamp, confidence, success, AU01_r, pose_Rx, AU01_c\n",
        "\xef\xbb\xbf"
        "frame,timestamp,confidence,success,AU01_r,pose_Rx,AU45_c\r\n",
        "\"frame\" ,\ttimestamp, confidence , success, \"AU01_r\", pose_Rx , p_0\n"}) {
    const auto clip = Read(header + rows);
    ASSERT_TRUE(clip.ok()) << clip.status().message();
    EXPECT_EQ(clip->track.points, (std::vector<std::string>{"AU01_r", "pose_Rx"}));
    EXPECT_EQ(clip->track.frames, 2);
    EXPECT_EQ(clip->track.frame_rate, 25);
    EXPECT_EQ(clip->track.values, (std::vector<float>{0.25f, -0.15f, 0.5f, 0.1f}));
    EXPECT_EQ(clip->track.seen(1, 1), 0.9f);
    EXPECT_TRUE(clip->notes.empty()) << clip->notes.front();
  }
}

TEST_F(OpenFaceTest, TakesTheColumnsAskedFor) {
  const std::string text = "AU02_r,gaze_angle_x,AU01_r\n1,2,3\n";
  const auto clip = Read(text, {.columns = {"AU01_r", "gaze_angle_x"}, .frame_rate = 30});
  ASSERT_TRUE(clip.ok());
  EXPECT_EQ(clip->track.values, (std::vector<float>{3, 2}));
  EXPECT_EQ(clip->track.frame_rate, 30);
  EXPECT_EQ(Joined(clip->notes), "no timestamps that tell the frame rate: 30.0000 is taken\n");
  EXPECT_EQ(Error(text, {.columns = {"AU04_r"}}),
            "has no column \"AU04_r\", expected it of OpenFace");
}

TEST_F(OpenFaceTest, KeepsTheFaceFoundInMostFrames) {
  const auto clip = Read(
      "frame,face_id,timestamp,confidence,success,AU01_r\n"
      "1,0,0.000,0.9,1,1.0\n1,7,0.000,0.9,1,2.0\n"
      "2,0,0.040,0.9,0,1.1\n2,7,0.040,0.8,1,2.1\n"
      "3,0,0.080,0.9,1,1.2\n"
      "5,7,0.160,0.7,1,2.3\n");
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  EXPECT_EQ(clip->track.values, (std::vector<float>{2.0f, 2.1f, 0, 0, 2.3f}));
  EXPECT_EQ(clip->track.confidence, (std::vector<float>{0.9f, 0.8f, 0, 0, 0.7f}));
  EXPECT_EQ(Joined(clip->notes),
            "2 faces: face_id 7 is kept, which is found in most frames\n"
            "2 frames without the face: taken as lost\n");
}

TEST_F(OpenFaceTest, KeepsValuesOfFailedFrames) {
  const auto clip = Read(
      "frame,timestamp,confidence,success,AU01_r\n"
      "0,0,0.2,0,0.75\n1,0.1,0.98,1,-nan(ind)\n2,0.2,0.98,1,1\n3,0.3,-nan(ind),1,2\n");
  ASSERT_TRUE(clip.ok()) << clip.status().message();
  EXPECT_EQ(clip->track.values, (std::vector<float>{0.75f, 0, 1, 2}));
  EXPECT_EQ(clip->track.confidence, (std::vector<float>{0, 0, 0.98f, 0}));
  EXPECT_EQ(Joined(clip->notes),
            "3 frames without the face: taken as lost\n1 cell without a number: taken as lost\n");
}

TEST_F(OpenFaceTest, TellsTheFrameRate) {
  for (const double rate :
       {12.5, 15.0, 24e3 / 1001, 24.0, 25.0, 30e3 / 1001, 30.0, 50.0, 60e3 / 1001, 60.0}) {
    std::string text = "frame,timestamp,AU01_r\n";
    for (int t = 0; t < 400; ++t) {
      const int milliseconds = static_cast<int>(t / rate * 1000 + 0.5);
      const std::string digits = std::to_string(1000 + milliseconds % 1000).substr(1);
      text += std::to_string(t + 1) + "," + std::to_string(milliseconds / 1000) + "." + digits +
              ",0.5\n";
    }
    const auto clip = Read(text);
    ASSERT_TRUE(clip.ok());
    EXPECT_DOUBLE_EQ(clip->track.frame_rate, rate);
  }
  // All at one time, going back, too fast, one frame alone.
  for (const char* rows :
       {"0,1,1\n1,1,1\n", "0,1,1\n1,0,1\n", "0,0,1\n1,1e-9,1\n", "0,5,1\n", "0,nan,1\n1,nan,1\n"}) {
    const auto clip = Read(std::string("frame,timestamp,AU01_r\n") + rows);
    ASSERT_TRUE(clip.ok()) << clip.status().message();
    EXPECT_EQ(clip->track.frame_rate, 24) << rows;
  }
}

TEST_F(OpenFaceTest, SaysWhatIsWrong) {
  const std::string header = "frame,success,AU01_r\n";
  EXPECT_EQ(Error(""), "line 1: has no columns like AU01_r or pose_Rx, expected OpenFace's header");
  EXPECT_EQ(Error("a,b\n1,2\n"),
            "line 1: has no columns like AU01_r or pose_Rx, expected OpenFace's header");
  EXPECT_EQ(Error(header), "has no rows, expected one for each frame");
  EXPECT_EQ(Error("AU01_r,b,AU01_r\n"), "line 1: column \"AU01_r\" is there twice, expected once");
  EXPECT_EQ(Error(header + "0,1,1\n\n1,1\n"), "line 4: has 2 cells, but the header has 3");
  EXPECT_EQ(Error(header + "0,1,1,\n"), "line 2: has 4 cells, but the header has 3");
  EXPECT_EQ(Error(header + "0,1,\x1b[31mred\n"),
            "line 2: column \"AU01_r\": \"\\x1b[31mred\", expected a number within 1000000 of 0");
  EXPECT_EQ(Error(header + "0,1,1e7\n"),
            "line 2: column \"AU01_r\": \"1e7\", expected a number within 1000000 of 0");
  EXPECT_EQ(Error(header + "0,1,0x1\n"),
            "line 2: column \"AU01_r\": \"0x1\", expected a number within 1000000 of 0");
  for (const char* frame : {"-1", "0.5", "1e300", "nan", ""}) {
    EXPECT_EQ(Error(header + frame + ",1,1\n"),
              std::string("line 2: column \"frame\": \"") + frame + "\", expected a whole number");
  }
  EXPECT_EQ(Error(header + "5,1,1\n4,1,1\n"),
            "line 3: frame 4 follows frame 5, expected ascending numbers");
  EXPECT_EQ(Error(header + "5,1,1\n5,1,1\n"),
            "frame 5: face 0 is there twice, expected one row a frame and face");
  EXPECT_EQ(Error(header + "0,0,1\n1,0,1\n"),
            "no face in any of 2 frames, expected one with success 1");
  EXPECT_EQ(Error(header + "0,1,1\n500000,1,1\n"),
            "frames 0 to 500000, but only 2 of them are there, expected numbers that follow each "
            "other");
  EXPECT_EQ(Error(header + "0,1,1\n999999999999999,1,1\n"),
            "frames 0 to 999999999999999, expected at most 1,048,576 frames");
  EXPECT_EQ(Error(header + "0,1,1\n1,1,1\n2,1,1\n", {.max_rows = 2}),
            "line 4: expected at most 2 rows");
  EXPECT_EQ(Error(header + std::string(1 << 20, '1')),
            "line 2: has more than 262 kB, expected a line of numbers");
  EXPECT_NE(ReadOpenFace(folder_.path()).status().message().find("is a directory"),
            std::string::npos);
}

TEST_F(OpenFaceTest, ReadsLinesOfAnyLengthAcrossBlocks) {
  for (const std::size_t pad : {1u, 65500u, 65536u, 131072u}) {
    std::string text = "frame,AU01_r,note\n";
    for (int t = 0; t < 5; ++t) {
      text += std::to_string(t) + ",0." + std::to_string(t) + "," + std::string(pad, 'x') + "\n";
    }
    text.pop_back();  // the last line may end with the file
    const auto clip = Read(text);
    ASSERT_TRUE(clip.ok()) << clip.status().message();
    EXPECT_EQ(clip->track.values, (std::vector<float>{0, 0.1f, 0.2f, 0.3f, 0.4f}));
  }
}

TEST_F(OpenFaceTest, ReadsTheRealFiles) {
  if (SharedData().empty()) GTEST_SKIP() << "no data beside the repository (GESTUS_SHARED_DATA)";
  struct Case {
    const char* name;
    std::int64_t frames;
    double rate;
    float last_rz;
  };
  for (const Case& c : {Case{"demo", 490, 25, 0.272f}, Case{"head_test", 715, 30, 0.001f}}) {
    const auto clip = ReadOpenFace(SharedData() + "/facsvatar_openface/" + c.name + ".csv");
    ASSERT_TRUE(clip.ok()) << clip.status().message();
    EXPECT_EQ(clip->track.frames, c.frames);
    EXPECT_EQ(clip->track.frame_rate, c.rate);
    ASSERT_EQ(clip->track.point_count(), 20);
    EXPECT_EQ(clip->track.points[2], "pose_Rz");
    EXPECT_EQ(clip->track.points[3], "AU01_r");
    EXPECT_EQ(clip->track.value(c.frames - 1, 0, 2), c.last_rz);
    EXPECT_EQ(clip->track.seen(0, 0), 0.98f);
  }
}

}  // namespace
}  // namespace gestus::motion
