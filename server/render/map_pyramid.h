// A map's pyramid on the CPU, for maps in bands: what map_resolve.comp and map_adapt.comp do to colours.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace caustream::render {

// Texels of the finest `levels` levels, each half as many a side as the one before.
std::size_t pyramidTexels(int size, int levels);

// The levels added up at the finest: [texel][band]. `map` has them one after the other, finest first, as photon_trace
// deposits them (GLuint) or adaptPyramid() makes them (float).
template <class T>
std::vector<float> sumPyramid(const std::vector<T>& map, int size, int levels, int bands);

// The light of a finest level ([texel][band]) into a pyramid: where `enough` photons landed in four texels it stays, the rest
// goes to the texel above. Twin of map_adapt.comp.
std::vector<float> adaptPyramid(std::vector<float> finest, std::vector<std::uint32_t> landings, int size, int levels, int bands, double enough);

}  // namespace caustream::render
