// A page on which styles can be looked at: a map for each part of them (thesis Figure 6.6), their
// distances, what they were made of.
#ifndef GESTUS_MODELS_STYLES_GALLERY_H_
#define GESTUS_MODELS_STYLES_GALLERY_H_

#include <optional>
#include <string>
#include <vector>

#include "engine/status.h"
#include "models/styles/style.h"

namespace gestus::styles {

struct GalleryOptions {
  std::string weights;          ///< what to call the weights; may be empty
  std::optional<bool> trained;  ///< whether they are, where that is known
};

/// One HTML page that needs nothing else.  Its data stand in the element `data` as JSON: `names`,
/// and for each part `components`, `explained`, `neighbours` (more than ten styles), `cosine`,
/// `euclidean`, `norms`, to seven digits.  Errors: styles that are not alike, less than 2 or more
/// than 300.
Result<std::string> MakeGallery(const std::vector<Named>& styles, const GalleryOptions& options);

}  // namespace gestus::styles

#endif  // GESTUS_MODELS_STYLES_GALLERY_H_
