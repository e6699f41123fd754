// Pictures of floats as OpenEXR files: 32-bit channels with names that other programs know, ZIP, no losses.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "client/connection/image_file.h"

namespace caustream::shot {

// What the channels of a frame of this unit (stream.info) are called: R G B of colours, which are linear BT.709; Z of
// depths; N.X N.Y N.Z of normals; id of casters, as whole numbers; T.<nm>nm of a spectral map's bands, as in Fichet et al.
// 2021, "An OpenEXR Layout for Spectral Images": ratios to the light without the caster, as its transmittances are.
std::vector<std::string> exrChannels(const std::string& unit, int bands, const std::vector<double>& wavelengthsNm);

// `channels` has a name for each band. The error is a sentence that names the file.
connection::Written writeExr(const std::filesystem::path& file, const connection::Image& image, const std::vector<std::string>& channels);

}  // namespace caustream::shot
