// The hard-coded wavelengths and colours of the published algorithm (Blanchette 2012, table 2 and appendix A).
#pragma once
#include <span>

#include "optics/colour.h"

namespace caustream::render {

// How many of its wavelengths the published algorithm takes when `asked` (1..64, or kContinuous): 1, 7 or 21.
int thesisWavelengthCount(int asked);

// `count` of them (1, 7 or 21) from 380 to 680 nm in equal steps; 1 is 587.56 nm, white. `xyz` holds the colours as linear
// RGB weights that sum to (1, 1, 1), and `xyzToRgb` is the identity: there is no observer behind them.
optics::WavelengthSet thesisWavelengths(int count);
// The same for any wavelengths (ascending): colours between those of the table, rescaled to the same sum.
optics::WavelengthSet thesisWavelengthsAt(std::span<const double> nm);

}  // namespace caustream::render
