// Lines of the files that tests/models/wordpiece_expectations.py writes.
#ifndef GESTUS_TESTS_MODELS_TEXT_DATA_H_
#define GESTUS_TESTS_MODELS_TEXT_DATA_H_

#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace gestus::models {

inline std::string ReadTextData(const std::string& name) {
  std::ifstream file(std::string(GESTUS_TEXT_DATA) + "/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The parts of `line` between separators, empty ones too.
inline std::vector<std::string> Split(std::string_view line, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = line.find(separator, begin)) != line.npos; begin = end + 1)
    parts.emplace_back(line.substr(begin, end - begin));
  parts.emplace_back(line.substr(begin));
  return parts;
}

/// The rows of a table, without its first line.
inline std::vector<std::vector<std::string>> ReadTable(const std::string& name) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> lines = Split(ReadTextData(name), '\n');
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) rows.push_back(Split(lines[i], '\t'));
  return rows;
}

}  // namespace gestus::models

#endif  // GESTUS_TESTS_MODELS_TEXT_DATA_H_
