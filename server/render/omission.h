// What a frame leaves out where its scene does not need it. Each can be done all the same (Request::forced): the picture
// stays as it is, which a test checks, and the bench times the difference.
#pragma once
#include <array>
#include <cstdint>

namespace caustream::render {

enum class Omission : unsigned {
    UnchangedLight,   // the light's passes of a pose that is known
    UnlitGlass,       // the light's passes where no light lands behind a caster
    Colours,          // wavelengths, where no glass disperses
    NoShadow,         // the shadow, where nothing throws one
    Walls,            // receivers that can shade nothing, in the shadow and before the casters
    Absorption,       // where no glass absorbs
    OneWavelength,    // what joins one wavelength to the next, where there is one
    Cookie,           // where the light has none
    Textures,         // where a receiver has none
    Gloss,            // highlights, further lights and cookies on receivers without
    ShadowLookup,     // on receivers outside the shadow's view
    MapLookup,        // on receivers outside the map's view
    OuterMap,         // where all light landed in the inner one
    UnseenGlass,      // casters outside the camera's view
    Box,              // pixels outside the caster's box on the screen
    Picture,          // the camera's passes, where the light's images are looked at
    Count
};

struct OmissionName {
    const char* name;
    const char* what;   // in words, as the subject of "is left out"
};

inline constexpr std::array<OmissionName, static_cast<std::size_t>(Omission::Count)> kOmissions = {{
    {"unchanged_light", "the light's passes after a camera move"},
    {"unlit_glass", "the light's passes where no caster is lit"},
    {"colours", "all wavelengths but one where no glass disperses"},
    {"no_shadow", "the shadow where nothing throws one"},
    {"walls", "walls that shade nothing, in the shadow"},
    {"absorption", "absorption in clear glass"},
    {"one_wavelength", "steps from wavelength to wavelength where there is one"},
    {"cookie", "the cookie of a light that has none"},
    {"textures", "textures of receivers that have none"},
    {"gloss", "gloss and further lights where there are none"},
    {"shadow_lookup", "shadow lookups of receivers out of its view"},
    {"map_lookup", "map lookups of receivers out of its view"},
    {"outer_map", "the outer map where all light landed in the inner"},
    {"unseen_glass", "glass that the camera does not see"},
    {"box", "pixels outside the caster's box"},
    {"picture", "the camera's passes where the map is sent"},
}};

class Omissions {
   public:
    bool has(Omission omission) const { return bits_ >> static_cast<unsigned>(omission) & 1u; }
    void add(Omission omission) { bits_ |= 1u << static_cast<unsigned>(omission); }
    bool operator==(const Omissions&) const = default;

   private:
    std::uint32_t bits_ = 0;
};

}  // namespace caustream::render
