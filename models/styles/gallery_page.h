// The page of a gallery, without its data.
#ifndef GESTUS_MODELS_STYLES_GALLERY_PAGE_H_
#define GESTUS_MODELS_STYLES_GALLERY_PAGE_H_

namespace gestus::styles {

/// HTML up to the data, which are JSON without "<", and from there.
extern const char* const kGalleryHead;
extern const char* const kGalleryTail;

}  // namespace gestus::styles

#endif  // GESTUS_MODELS_STYLES_GALLERY_PAGE_H_
