// Reads arrays with the reader of infer-cli on behalf of npz_test.py.  Each line of standard input
// is "FILE<tab>ARRAY<tab>float32|int32<tab>OUT"; the array is written to OUT, an .npz, or to no
// file when OUT is "-".  The answer is one line, "ok" or "error: <sentence>".
#include <cstdio>
#include <iostream>
#include <new>
#include <sstream>
#include <string>

#include "models/cli/npz.h"
#include "models/io/file.h"
#include "models/io/text.h"

namespace {

using gestus::Status;

Status Copy(const std::string& in, const std::string& name, const std::string& dtype,
            const std::string& out) {
  gestus::models::ArraySpec spec;
  spec.name = name;
  spec.dtype = dtype == "int32" ? gestus::DType::kI32 : gestus::DType::kF32;
  const auto contents = gestus::cli::ReadNpz(in, {spec});
  if (!contents.ok() || out == "-") return contents.status();
  auto file = gestus::AtomicFile::Create(out);
  if (!file.ok()) return file.status();
  GESTUS_RETURN_IF_ERROR(gestus::cli::WriteNpz(contents->arrays, &*file));
  return file->Commit();
}

}  // namespace

int main() {
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream fields(line);
    std::string in, name, dtype, out;
    std::getline(fields, in, '\t');
    std::getline(fields, name, '\t');
    std::getline(fields, dtype, '\t');
    std::getline(fields, out, '\t');
    try {
      const Status status = Copy(in, name, dtype, out);
      std::puts(status.ok() ? "ok" : ("error: " + gestus::OneLine(status.message())).c_str());
    } catch (const std::bad_alloc&) {
      std::puts("crash: out of memory");
    }
  }
  return 0;
}
