// Reading .npz: open and check the whole archive first, then inflate only what is wanted.
#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "models/cli/npy.h"
#include "models/cli/npz.h"
#include "models/run_support.h"

namespace gestus::cli {
namespace {

using models::Array;
using models::ArraySpec;

struct ArchiveCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct MemberCloser {
  void operator()(zip_file_t* member) const { zip_fclose(member); }
};
using Archive = std::unique_ptr<zip_t, ArchiveCloser>;
using MemberFile = std::unique_ptr<zip_file_t, MemberCloser>;

struct Member {
  zip_uint64_t index = 0;
  std::string name;  // of the array: the member's without ".npy"
  std::uint64_t size = 0;
  std::uint64_t packed_size = 0;
};

std::string ZipErrorText(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

bool StartsWith(int fd, const char* magic, std::size_t size) {
  char start[8] = {};
  return ::pread(fd, start, size, 0) == static_cast<ssize_t>(size) &&
         std::memcmp(start, magic, size) == 0;
}

Result<Archive*> Open(InputFile* file, Archive* archive) {
  if (file->size == 0) return BadInput("is empty, expected an .npz file");
  const bool is_zip = StartsWith(file->fd.get(), "PK", 2);
  int code = 0;
  // ZIP_CHECKCONS compares each local header with the central directory.
  archive->reset(zip_fdopen(file->fd.get(), ZIP_CHECKCONS, &code));
  if (*archive != nullptr) {
    file->fd.Release();  // libzip owns it now
    return archive;
  }
  if (code != ZIP_ER_NOZIP) return BadInput(ZipErrorText(code) + ", expected an .npz file");
  return is_zip
             ? BadInput("is a zip file without an end (truncated?), expected a complete .npz file")
             : BadInput("is not a zip file, expected an .npz file");
}

// "NAME.npy"; folders are allowed in names (infer-cli writes "tap/..."), ways out of them are not.
bool IsArrayName(std::string_view name) {
  constexpr std::string_view kSuffix = ".npy";
  if (name.size() <= kSuffix.size() || name.size() > 255 || !name.ends_with(kSuffix)) return false;
  name.remove_suffix(kSuffix.size());
  for (const char c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\' || c == ':') return false;
  }
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    const std::string_view part = name.substr(begin, end - begin);
    if (part.empty() || part == "." || part == "..") return false;
    begin = end + 1;
  }
  return true;
}

Result<Member> Stat(zip_t* archive, zip_uint64_t index) {
  zip_stat_t stat;
  constexpr zip_uint64_t kNeeded = ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE |
                                   ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
  if (zip_stat_index(archive, index, ZIP_FL_ENC_RAW, &stat) != 0 ||
      (stat.valid & kNeeded) != kNeeded) {
    return BadInput("member " + std::to_string(index) + ": " + zip_strerror(archive));
  }
  Member member;
  member.name = stat.name;
  if (!IsArrayName(member.name)) return BadInput(member.name + ": unusual name, expected NAME.npy");
  member.name.resize(member.name.size() - 4);
  member.index = index;
  member.size = stat.size;
  member.packed_size = stat.comp_size;
  if (stat.encryption_method != ZIP_EM_NONE)
    return BadInput(member.name + ": encrypted, expected not");
  const bool stored = stat.comp_method == ZIP_CM_STORE;
  if (!stored && stat.comp_method != ZIP_CM_DEFLATE) {
    return BadInput(member.name + ": zip compression method " + std::to_string(stat.comp_method) +
                    ", expected stored (0) or deflate (8)");
  }
  if (stored && stat.size != stat.comp_size) {
    return BadInput(member.name + ": " + std::to_string(stat.comp_size) +
                    " bytes stored, expected " + std::to_string(stat.size));
  }
  return member;
}

// All members of the archive, in its order, with distinct names.
Result<std::vector<Member>> List(zip_t* archive, std::uint64_t file_size, const NpzLimits& limits) {
  const auto count = static_cast<std::uint64_t>(zip_get_num_entries(archive, 0));
  if (count > limits.max_members) {
    return BadInput(std::to_string(count) + " members, expected at most " +
                    std::to_string(limits.max_members));
  }
  std::vector<Member> members;
  std::vector<std::string> names;
  std::uint64_t packed = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    Result<Member> member = Stat(archive, i);
    if (!member.ok()) return member.status();
    // Together more than the file: members that share their bytes, as zip bombs do.
    if (member->packed_size > file_size - packed) {
      return BadInput(member->name + ": overlaps other members, expected members side by side");
    }
    packed += member->packed_size;
    names.push_back(member->name);
    members.push_back(std::move(*member));
  }
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) return BadInput(*twice + ": there twice, expected once");
  return members;
}

Status CheckRatio(const Member& member, const NpzLimits& limits) {
  if (member.size <= limits.ratio_free_bytes ||
      member.size / limits.max_ratio <= member.packed_size) {
    return Status();
  }
  return BadInput(std::to_string(member.packed_size) + " bytes inflate to " +
                  std::to_string(member.size) + " (a zip bomb?), expected at most " +
                  std::to_string(limits.max_ratio) + " times as many");
}

Result<Array> ReadMember(zip_t* archive, const Member& member, DType dtype, std::uint64_t max_bytes,
                         const NpzLimits& limits) {
  GESTUS_RETURN_IF_ERROR(CheckRatio(member, limits));
  const MemberFile file(zip_fopen_index(archive, member.index, 0));
  if (file == nullptr)
    return BadInput(std::string(zip_strerror(archive)) + ", expected a whole member");
  const ByteReader read = [&file](void* data, std::size_t size) -> Result<std::size_t> {
    const zip_int64_t n = zip_fread(file.get(), data, size);
    if (n >= 0) return static_cast<std::size_t>(n);
    return BadInput(std::string(zip_file_strerror(file.get())) + ", expected an undamaged member");
  };
  return ReadNpy(read, member.size, dtype, max_bytes);
}

// "speech, text and 3 more"
std::string NameList(const std::vector<Member>& members) {
  constexpr std::size_t kShown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(members.size(), kShown); ++i) {
    text += (i == 0 ? "" : ", ") + members[i].name;
  }
  if (members.size() > kShown) text += " and " + std::to_string(members.size() - kShown) + " more";
  return members.empty() ? "no arrays" : text;
}

Result<NpzContents> ReadWanted(zip_t* archive, const std::vector<Member>& members,
                               const std::vector<ArraySpec>& wanted, const NpzLimits& limits) {
  NpzContents contents;
  std::uint64_t left = limits.max_bytes;
  for (const ArraySpec& spec : wanted) {
    const auto member = std::find_if(members.begin(), members.end(),
                                     [&](const Member& m) { return m.name == spec.name; });
    if (member == members.end()) {
      if (!spec.required) continue;
      return BadInput(spec.name + ": missing, found " + NameList(members) + ", expected an array " +
                      spec.name);
    }
    Result<Array> array = ReadMember(archive, *member, spec.dtype, left, limits);
    if (!array.ok()) return array.status().In(spec.name);
    GESTUS_RETURN_IF_ERROR(models::CheckFinite(spec.name, *array, Code::kBadInput));
    left -= 4 * (array->f32.size() + array->i32.size());
    contents.arrays.emplace(spec.name, std::move(*array));
  }
  for (const Member& member : members) {
    const bool known = std::any_of(wanted.begin(), wanted.end(),
                                   [&](const ArraySpec& spec) { return spec.name == member.name; });
    if (!known) contents.others.push_back(member.name);
  }
  return contents;
}

Result<NpzContents> ReadBare(const InputFile& file, const std::vector<ArraySpec>& wanted,
                             const NpzLimits& limits) {
  const ArraySpec* only = nullptr;
  std::size_t required = 0;
  for (const ArraySpec& spec : wanted) {
    if (spec.required && ++required == 1) only = &spec;
  }
  if (required != 1) {
    return BadInput("is a single .npy array, expected an .npz file" +
                    (required == 0 ? "" : " with " + std::to_string(required) + " arrays"));
  }
  const ByteReader read = [&file](void* data, std::size_t size) -> Result<std::size_t> {
    const ssize_t n = ::read(file.fd.get(), data, size);
    if (n >= 0) return static_cast<std::size_t>(n);
    return Status(Code::kIo, std::string("cannot be read: ") + std::strerror(errno));
  };
  Result<Array> array = ReadNpy(read, file.size, only->dtype, limits.max_bytes);
  if (!array.ok()) return array.status();
  GESTUS_RETURN_IF_ERROR(models::CheckFinite(only->name, *array, Code::kBadInput));
  NpzContents contents;
  contents.arrays.emplace(only->name, std::move(*array));
  return contents;
}

Result<NpzContents> Read(const std::string& path, const std::vector<ArraySpec>& wanted,
                         const NpzLimits& limits) {
  Result<InputFile> file = OpenInput(path);
  if (!file.ok()) return file.status();
  if (StartsWith(file->fd.get(), "\x93NUMPY", 6)) return ReadBare(*file, wanted, limits);
  Archive archive;
  const Result<Archive*> opened = Open(&*file, &archive);
  if (!opened.ok()) return opened.status();
  const Result<std::vector<Member>> members = List(archive.get(), file->size, limits);
  if (!members.ok()) return members.status();
  return ReadWanted(archive.get(), *members, wanted, limits);
}

}  // namespace

Result<NpzContents> ReadNpz(const std::string& path, const std::vector<ArraySpec>& wanted,
                            const NpzLimits& limits) {
  Result<NpzContents> contents = Read(path, wanted, limits);
  if (!contents.ok()) return contents.status().In(path);
  return contents;
}

Result<std::vector<std::string>> ListNpz(const std::string& path, const NpzLimits& limits) {
  // Wanting nothing reads nothing: every name comes back as another's.
  Result<NpzContents> contents = ReadNpz(path, {}, limits);
  if (!contents.ok()) return contents.status();
  return std::move(contents->others);
}

}  // namespace gestus::cli
