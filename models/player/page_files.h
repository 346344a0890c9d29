// The files of models/player/page, which the build turns into constants.  A private header of
// models/player.
#ifndef GESTUS_MODELS_PLAYER_PAGE_FILES_H_
#define GESTUS_MODELS_PLAYER_PAGE_FILES_H_

#include <string_view>

namespace gestus::player {

extern const std::string_view kPageHtml;    ///< page.html, with {{names}} of what goes where
extern const std::string_view kPageStyle;   ///< player.css
extern const std::string_view kPageScript;  ///< the scripts, in their order

}  // namespace gestus::player

#endif  // GESTUS_MODELS_PLAYER_PAGE_FILES_H_
