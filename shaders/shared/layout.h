// Numbers that C++ and GLSL must agree on; compiles as both.
#ifdef __cplusplus
#pragma once
namespace caustream::layout {
#define LAYOUT_CONST inline constexpr int
#else
#define LAYOUT_CONST const int
#endif

LAYOUT_CONST kMostWavelengths = 64;
LAYOUT_CONST kMostNodes = 7;           // exact wavelengths of a continuous spectrum
LAYOUT_CONST kSpectrumSteps = 128;     // of its table of colours
LAYOUT_CONST kGroupSize = 64;          // threads of a one-dimensional compute group
LAYOUT_CONST kScanTexels = 16;         // texels one thread of photon_list looks at
LAYOUT_CONST kMostLevels = 5;          // of the map's pyramid: a photon may be spread over 16 texels
LAYOUT_CONST kMapWords = 4;           // uints a texel of the map: X, Y of the even photons, Y of the odd ones, Z
LAYOUT_CONST kMapX = 0;
LAYOUT_CONST kMapEvenY = 1;            // odd: the next
LAYOUT_CONST kMapZ = 3;
LAYOUT_CONST kWideWords = 8;          // uints a texel of the exact map: the same four as sums of 64 bits, low word first
LAYOUT_CONST kWideEvenY = 2;           // odd: two words on
LAYOUT_CONST kWideZ = 6;
LAYOUT_CONST kListHeader = 4;          // uints before a photon list's texels: the dispatch size (3), the photon count

// Shader storage bindings
LAYOUT_CONST kBindList = 0;
LAYOUT_CONST kBindMap = 1;
LAYOUT_CONST kBindLedger = 2;
LAYOUT_CONST kBindRetry = 3;
LAYOUT_CONST kBindResiduals = 4;
LAYOUT_CONST kBindOuterMap = 5;
LAYOUT_CONST kBindLandings = 6;
LAYOUT_CONST kBindOuterLandings = 7;

// Rows of the energy ledger, fixed point in the map's unit, luminance-weighted. Each exists kLedgerBanks times, a cache
// line apart, so that two processors do not wait for each other; the banks are summed on the CPU.
LAYOUT_CONST kLedgerOnCasters = 0;
LAYOUT_CONST kLedgerAbsorbed = 1;
LAYOUT_CONST kLedgerReflected = 2;
LAYOUT_CONST kLedgerTotalReflection = 3;
LAYOUT_CONST kLedgerRejected = 4;
LAYOUT_CONST kLedgerLeftMap = 5;
LAYOUT_CONST kLedgerNoReceiver = 6;
LAYOUT_CONST kLedgerDeposited = 7;
LAYOUT_CONST kLedgerPhotons = 8;       // a count, not flux
LAYOUT_CONST kLedgerHalves = 9;        // what the two halves of the photons differ by in the inner map, over its texels
LAYOUT_CONST kLedgerRoughness = 10;    // what texels of the pyramid's coarser levels differ from their neighbours by, / 16
LAYOUT_CONST kLedgerStep = 11;         // what the map would change by, were each wavelength spread over its stretch
LAYOUT_CONST kLedgerStepOf = 12;       // of this luminance
LAYOUT_CONST kLedgerGrain = 13;        // what texels of the finest level differ from their neighbours in the row by, / 16
LAYOUT_CONST kLedgerOuter = 14;        // the part of kLedgerDeposited in the outer map
LAYOUT_CONST kLedgerCut = 15;          // exact paths with too many bounces, or too weak to follow
LAYOUT_CONST kLedgerCells = 16;        // traced: what the two halves differ by on cells of 4 x 4 texels
LAYOUT_CONST kLedgerRows = 32;         // of 4 bytes: two cache lines
LAYOUT_CONST kLedgerBanks = 32;

// Histograms of residuals over tolerance (common/residuals.glsl): below 1e-6, six decades up to 1, 1 to 10, above.
LAYOUT_CONST kResidualExit = 0;            // exit point, searched from nothing
LAYOUT_CONST kResidualExitFollowed = 1;    // exit point, one step from a neighbour's
LAYOUT_CONST kResidualReceiver = 2;        // meeting with a receiver
LAYOUT_CONST kResidualHistograms = 3;
LAYOUT_CONST kResidualBins = 9;

#ifdef __cplusplus
}
#endif
#undef LAYOUT_CONST
