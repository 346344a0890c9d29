# Turns text files into a C++ constant each:
#   cmake -D OUTPUT=page_files.cc -D "CONSTANTS=kA=a.html|kB=b.js,c.js" -P embed.cmake
# Files that share a constant are joined in their order.
set(text "// Made by models/player/embed.cmake.\n#include \"models/player/page_files.h\"\n\n")
string(APPEND text "namespace gestus::player {\n\n")
string(REPLACE "|" ";" constants "${CONSTANTS}")
foreach(constant IN LISTS constants)
  string(REPLACE "=" ";" parts "${constant}")
  list(GET parts 0 name)
  list(GET parts 1 files)
  string(REPLACE "," ";" files "${files}")
  set(bytes "")
  foreach(file IN LISTS files)
    file(READ "${file}" more HEX)
    string(APPEND bytes "${more}")
  endforeach()
  string(LENGTH "${bytes}" digits)
  math(EXPR size "${digits} / 2")
  # Eight bytes a line; escapes, since a literal could not hold every file as it is.
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
  string(REGEX REPLACE "((\\\\x..)(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?(\\\\x..)?)"
         "\"\\1\"\n" bytes "${bytes}")
  string(APPEND text "const std::string_view ${name}(\n${bytes}, ${size});\n\n")
endforeach()
string(APPEND text "}  // namespace gestus::player\n")
file(WRITE "${OUTPUT}" "${text}")
