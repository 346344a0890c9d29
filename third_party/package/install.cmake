# What `cmake --install` puts where, for programs that embed gestus: the libraries, their
# headers, a CMake package (find_package(gestus), targets gestus::models, gestus::features and so on)
# and pkg-config files.
include(CMakePackageConfigHelpers)

function(gestus_install_library part)
  set_target_properties(gestus_${part} PROPERTIES EXPORT_NAME ${part})
  install(TARGETS gestus_${part} EXPORT gestus ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

function(gestus_install_headers)
  foreach(header IN LISTS ARGN)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gestus/${folder})
  endforeach()
endfunction()

function(gestus_install_pkgconfig name template)
  configure_file(third_party/package/${template}.pc.in ${CMAKE_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

# What lies before and behind the networks: each part a library of its own, so that who wants the
# networks alone needs nothing of it.  Of its headers those that are named here are for everybody; the
# rest are its inside.
#
#   gestus_install_part(audio "Sound" REQUIRES gestus-io HEADERS source stage)
function(gestus_install_part part description)
  if(NOT TARGET gestus_${part})
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "REQUIRES;HEADERS")
  gestus_install_library(${part})
  list(TRANSFORM arg_HEADERS REPLACE "(.+)" "models/${part}/\\1.h")
  gestus_install_headers(${arg_HEADERS})
  list(JOIN arg_REQUIRES " " requires)
  gestus_install_pkgconfig(gestus-${part} gestus-part)
endfunction()

foreach(part kernels engine models)
  gestus_install_library(${part})
endforeach()
set(parts audio features io metrics motion outputs player prosody styles text words)
get_property(targets DIRECTORY models PROPERTY BUILDSYSTEM_TARGETS)
foreach(target IN LISTS targets)
  get_target_property(type ${target} TYPE)
  string(REPLACE gestus_ "" part ${target})
  if(type STREQUAL STATIC_LIBRARY AND NOT part IN_LIST parts AND NOT part STREQUAL models)
    message(FATAL_ERROR "${target} is not installed: name it in third_party/package/install.cmake")
  endif()
endforeach()
file(GLOB headers RELATIVE ${CMAKE_SOURCE_DIR} engine/*.h models/*.h models/*/*.h)
foreach(folder IN LISTS parts ITEMS cli)
  list(FILTER headers EXCLUDE REGEX "^models/${folder}/")
endforeach()
gestus_install_headers(kernels/kernels.h ${headers})
gestus_install_pkgconfig(gestus gestus)

if(GESTUS_SNDFILE_LIBRARY)
  set(sndfile sndfile)
endif()
gestus_install_part(io "Files and numbers, for the other parts" REQUIRES gestus)
gestus_install_part(text "Words to the tokens of BERT" REQUIRES gestus libutf8proc
                    HEADERS vocabulary wordpiece)
gestus_install_part(audio "Recordings to what the networks hear" REQUIRES gestus-io ${sndfile}
                    HEADERS fbank frames log_mel resampler rows source stage)
gestus_install_part(prosody "Recordings to pitch and voice quality" REQUIRES gestus-audio
                    HEADERS contour swipe voice_quality)
gestus_install_part(words "Transcripts to words in time" REQUIRES gestus-io
                    HEADERS frames transcript units)
gestus_install_part(motion "Key points and action units to poses" REQUIRES gestus-io
                    HEADERS clean clip joints openface openpose resample select)
gestus_install_part(features "Recordings and words to the inputs of a network"
                    REQUIRES gestus-text gestus-prosody gestus-words gestus-motion
                    HEADERS front_end input_stream spec stages word_encoder)
gestus_install_part(outputs "What networks put out, as motion and in the files of other programs"
                    REQUIRES gestus-motion HEADERS finish formats motion)
gestus_install_part(metrics "The measures of the thesis' evaluations" REQUIRES gestus-outputs
                    HEADERS activity behaviour error measure points similarity transfer)
gestus_install_part(styles "Styles to mix, compare and show" REQUIRES gestus-io
                    HEADERS blend distance gallery style)
gestus_install_part(player "Motion to look at" REQUIRES gestus-outputs gestus-words
                    HEADERS page sheet show video)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/gestus)
install(EXPORT gestus NAMESPACE gestus:: FILE gestusTargets.cmake DESTINATION ${package})
configure_package_config_file(third_party/package/gestusConfig.cmake.in
                              ${CMAKE_BINARY_DIR}/gestusConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/gestusConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/gestusConfig.cmake ${CMAKE_BINARY_DIR}/gestusConfigVersion.cmake
        DESTINATION ${package})
