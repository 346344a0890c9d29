# How each dependency is found.  Everything comes from Debian packages (third_party/README.md names
# them); nothing is vendored and nothing is downloaded.

# xsimd 8.1, header only: the SIMD batches of kernels/.  The include path is shared with the system,
# so the target only proves that the package is there.
if(CMAKE_CROSSCOMPILING)
  # Its CMake package lies below the build machine's architecture; the headers serve every one.
  find_path(GESTUS_XSIMD_INCLUDE xsimd/xsimd.hpp REQUIRED)
else()
  find_package(xsimd 8.1 REQUIRED)
endif()

# FlatBuffers 2.0.8.  The generated header insists on the exact library version, so it is generated
# at build time, never committed.
find_path(GESTUS_FLATBUFFERS_INCLUDE flatbuffers/flatbuffers.h REQUIRED)
find_program(GESTUS_FLATC flatc REQUIRED)

# XXH3 for the checksum of weights files.
find_path(GESTUS_XXHASH_INCLUDE xxhash.h REQUIRED)

# libutf8proc 2.8: the Unicode of models/text.  Debian has it for the build machine only; a cross build
# without it leaves that part out.
find_path(GESTUS_UTF8PROC_INCLUDE utf8proc.h)
find_library(GESTUS_UTF8PROC_LIBRARY utf8proc)
if(NOT GESTUS_UTF8PROC_INCLUDE OR NOT GESTUS_UTF8PROC_LIBRARY)
  if(NOT CMAKE_CROSSCOMPILING)
    message(FATAL_ERROR "libutf8proc not found: install libutf8proc-dev")
  endif()
  message(STATUS "No libutf8proc for ${CMAKE_SYSTEM_PROCESSOR}: gestus_text (words to BERT tokens) "
                 "and its tests are left out")
  set(GESTUS_UTF8PROC_LIBRARY "")
endif()

find_package(Threads REQUIRED)

# Headers only, which serve every architecture: the FFT of Eigen for models/audio, JSON for models/io.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)

# libsndfile 1.2 reads FLAC, OGG and MP3 in models/audio, where it is there; WAV needs no library.
option(GESTUS_SNDFILE "Read more sound files than WAV, with libsndfile where it is found" ON)
set(GESTUS_SNDFILE_LIBRARY "")
if(GESTUS_SNDFILE AND NOT CMAKE_CROSSCOMPILING)
  find_path(GESTUS_SNDFILE_INCLUDE sndfile.h)
  find_library(GESTUS_SNDFILE_FOUND sndfile)
  if(GESTUS_SNDFILE_INCLUDE AND GESTUS_SNDFILE_FOUND)
    set(GESTUS_SNDFILE_LIBRARY ${GESTUS_SNDFILE_FOUND})
  else()
    message(STATUS "No libsndfile: sound files are WAV only")
  endif()
endif()

# libzip reads and writes .npz, CLI11 parses the command line.
if(GESTUS_BUILD_CLI OR GESTUS_BUILD_TESTS)
  find_package(PkgConfig)
  if(PkgConfig_FOUND AND NOT CMAKE_CROSSCOMPILING)
    pkg_check_modules(libzip IMPORTED_TARGET libzip>=1.7)
    find_package(CLI11 2.1)
  endif()
endif()

if(GESTUS_BUILD_TESTS AND NOT CMAKE_CROSSCOMPILING)
  find_package(GTest 1.12 REQUIRED)
endif()

if(GESTUS_BUILD_BENCH)
  find_package(benchmark 1.7 REQUIRED)
  find_package(OpenMP REQUIRED COMPONENTS CXX)
endif()
