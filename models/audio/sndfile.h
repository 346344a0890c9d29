// Sound files by libsndfile.  A private header of the front end, compiled only where the library
// is.
#ifndef GESTUS_MODELS_AUDIO_SNDFILE_H_
#define GESTUS_MODELS_AUDIO_SNDFILE_H_

#include <memory>
#include <string>

#include "engine/status.h"
#include "models/audio/source.h"
#include "models/io/file.h"

namespace gestus::audio {

/// FLAC, Ogg Vorbis and Opus, MP3, AIFF and whatever else the library knows.  The error begins with
/// the path.
Result<std::unique_ptr<AudioSource>> OpenSndfile(const std::string& path, InputFile file);

}  // namespace gestus::audio

#endif  // GESTUS_MODELS_AUDIO_SNDFILE_H_
