// Opening weights files: what a good one gives, what damage does, what becomes of a file that
// changes while it is open.
#include "engine/weights_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/engine/temp_file.h"
#include "tests/engine/weights_builder.h"

namespace gestus::test {
namespace {

auto FromBytes(const Bytes& bytes) {
  return WeightsFile::FromMemory(bytes.data(), bytes.size(), "memory");
}

/// Reads every element of every tensor and every field of every network.
double ReadEverything(const WeightsFile& file) {
  double sum = static_cast<double>(file.checksum() % 7) + file.format_version();
  for (const WeightsFile::Entry& e : file.tensors()) {
    sum += static_cast<double>(e.name.size());
    const auto* bytes = static_cast<const unsigned char*>(e.view.data);
    for (std::uint64_t i = 0; i < e.bytes; ++i) sum += bytes[i];
    const auto elements = static_cast<std::size_t>(e.view.shape.NumElements());
    EXPECT_EQ(e.bytes, elements * SizeOf(e.view.dtype));
    if (e.view.dtype == DType::kF32) {
      for (std::size_t i = 0; i < elements; ++i) EXPECT_TRUE(std::isfinite(e.view.f32()[i]));
    }
    EXPECT_EQ(file.Find(e.name), &e);
  }
  for (const fb::Network* n : *file.root().networks()) {
    sum += n->name()->size() + n->prefix()->size();
    if (const fb::AstConfig* c = n->config_as_AstConfig()) sum += c->frames() + c->heads();
    if (n->joints() != nullptr) {
      for (const fb::Joint* j : *n->joints()) sum += j->name()->size() + j->source();
    }
    if (n->normalisations() != nullptr) {
      for (const fb::Normalisation* s : *n->normalisations()) {
        sum += s->stream()->size();
        for (float m : *s->mean()) sum += std::isfinite(m) ? 0 : 1;
        for (float d : *s->deviation()) sum += std::isfinite(d) ? 0 : 1;
      }
    }
    if (const fb::SelfTest* t = n->self_test()) {
      for (const auto* name : *t->inputs()) sum += name->size();
      for (const auto* name : *t->input_names()) sum += name->size();
      sum += t->output()->size() + t->output_name()->size();
    }
  }
  return sum;
}

void ExpectGood(const WeightsFile& file) {
  ASSERT_EQ(file.tensors().size(), 3u);
  const WeightsFile::Entry* a = file.Find("n.a");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(a->view.shape, (Shape{2, 3}));
  EXPECT_EQ(a->bytes, 24u);
  EXPECT_EQ(a->view.dtype, DType::kF32);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(a->view.f32()[i], static_cast<float>(i + 1));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(a->view.data) % 64, 0u);
  const WeightsFile::Entry* b = file.Find("n.b");
  ASSERT_NE(b, nullptr);
  EXPECT_EQ(b->view.shape.rank(), 0);
  EXPECT_EQ(b->view.f32()[0], 7.0f);
  ASSERT_NE(file.Find("n.c"), nullptr);
  EXPECT_EQ(file.Find("n.c")->view.dtype, DType::kI32);
  EXPECT_EQ(file.Find("n."), nullptr);
  EXPECT_EQ(file.Find("n.d"), nullptr);
  EXPECT_NE(file.FindNetwork(""), nullptr);
  EXPECT_EQ(file.FindNetwork("net"), file.FindNetwork(""));
  EXPECT_EQ(file.FindNetwork("other"), nullptr);
  EXPECT_EQ(file.format_version(), 1u);
}

TEST(WeightsFileTest, OpensFromMemory) {
  const Bytes bytes = GoodFile().Build();
  const auto file = FromBytes(bytes);
  ASSERT_TRUE(file.ok()) << file.status().message();
  ExpectGood(**file);
  EXPECT_EQ((*file)->path(), "memory");
  EXPECT_EQ((*file)->file_size(), bytes.size());
  EXPECT_GT(ReadEverything(**file), 0);
}

TEST(WeightsFileTest, OpensFromMemoryAtAnyAddress) {
  const Bytes bytes = GoodFile().Build();
  for (std::size_t shift : {1u, 2u, 3u, 7u, 63u}) {
    Bytes moved(shift);
    moved.insert(moved.end(), bytes.begin(), bytes.end());
    const auto file = WeightsFile::FromMemory(moved.data() + shift, bytes.size(), "memory");
    ASSERT_TRUE(file.ok()) << file.status().message();
    ExpectGood(**file);
  }
}

TEST(WeightsFileTest, SeveralNetworksNeedAName) {
  FileSpec spec = GoodFile();
  spec.networks.push_back(NetworkSpec{.name = "second", .prefix = "n."});
  const auto file = FromBytes(spec.Build());
  ASSERT_TRUE(file.ok()) << file.status().message();
  EXPECT_EQ((*file)->FindNetwork(""), nullptr);
  ASSERT_NE((*file)->FindNetwork("second"), nullptr);
  EXPECT_EQ((*file)->FindNetwork("second")->name()->str(), "second");
}

TEST(WeightsFileTest, EveryTruncationIsRejected) {
  const Bytes bytes = GoodFile().Build();
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    // Of its own size, so that a read past the end is a read past an allocation.
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    const auto file = FromBytes(cut);
    ASSERT_FALSE(file.ok()) << "accepted the first " << n << " of " << bytes.size() << " bytes";
    ASSERT_EQ(file.status().code(), Code::kBadWeights);
  }
}

TEST(WeightsFileTest, EveryFlippedBitIsRejected) {
  Bytes bytes = GoodFile().Build();
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << bit % 8));
    ASSERT_FALSE(FromBytes(bytes).ok()) << "bit " << bit;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << bit % 8));
  }
  ASSERT_TRUE(FromBytes(bytes).ok());
}

// What a malicious or broken writer could do: the checksum fits, so the later checks must hold.
TEST(WeightsFileTest, EveryFlippedBitWithAFittingChecksumIsRejectedOrSafe) {
  const Bytes good = GoodFile().Build();
  std::size_t accepted = 0, rejected = 0;
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes bytes = good;
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << bit % 8));
    if (bit / 8 < kChecksumAt || bit / 8 >= kMetadataAt) RefreshChecksum(&bytes);
    const auto file = FromBytes(bytes);
    if (file.ok()) {
      ReadEverything(**file);
      ++accepted;
    } else {
      ASSERT_FALSE(file.status().message().empty());
      for (char c : file.status().message()) ASSERT_TRUE(c >= 0x20 && c < 0x7f) << "bit " << bit;
      ++rejected;
    }
  }
  // Bits of payloads, padding and configuration values are free; those of structure are not.
  EXPECT_GT(accepted, std::size_t{0});
  EXPECT_GT(rejected, std::size_t{1000});
}

class ResidenceTest : public testing::TestWithParam<Residence> {
 protected:
  LoadOptions options_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Both, ResidenceTest,
                         testing::Values(Residence::kMapped, Residence::kCopied),
                         [](const auto& test) {
                           return test.param == Residence::kMapped ? "Mapped" : "Copied";
                         });

TEST_P(ResidenceTest, OpensAFile) {
  const TempFile temp(GoodFile().Build());
  const auto file = WeightsFile::Open(temp.path(), options_);
  ASSERT_TRUE(file.ok()) << file.status().message();
  ExpectGood(**file);
  EXPECT_EQ((*file)->path(), temp.path());
}

TEST_P(ResidenceTest, SurvivesReplacementAndRemovalOfTheFile) {
  const TempFile temp(GoodFile().Build());
  const auto file = WeightsFile::Open(temp.path(), options_);
  ASSERT_TRUE(file.ok());
  const double before = ReadEverything(**file);
  const TempFile other(Bytes(100, 0xff));
  std::filesystem::rename(other.path(), temp.path());
  EXPECT_EQ(ReadEverything(**file), before);
  std::filesystem::remove(temp.path());
  EXPECT_EQ(ReadEverything(**file), before);
}

TEST(WeightsFileTest, ACopySurvivesTruncationAndOverwriting) {
  const TempFile temp(GoodFile().Build());
  const auto file = WeightsFile::Open(temp.path(), {.residence = Residence::kCopied});
  ASSERT_TRUE(file.ok());
  const double before = ReadEverything(**file);
  std::ofstream(temp.path(), std::ios::binary | std::ios::in) << std::string(200, 'x');
  EXPECT_EQ(ReadEverything(**file), before);
  ASSERT_EQ(truncate(temp.path().c_str(), 0), 0);
  EXPECT_EQ(ReadEverything(**file), before);
}

std::size_t OpenFiles() {
  std::size_t n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    ++n;
  return n;
}

TEST(WeightsFileTest, LeavesNoDescriptorOpen) {
  const TempFile good(GoodFile().Build()), bad(Bytes(500, 1));
  const std::size_t before = OpenFiles();
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(WeightsFile::Open(good.path()).ok());
    ASSERT_TRUE(WeightsFile::Open(good.path(), {.residence = Residence::kCopied}).ok());
    ASSERT_FALSE(WeightsFile::Open(bad.path()).ok());
  }
  EXPECT_EQ(OpenFiles(), before);
}

}  // namespace
}  // namespace gestus::test
