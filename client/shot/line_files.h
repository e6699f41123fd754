// The files of a batch's line: each is there whole or not at all, and NAME.json, the last, says which there are.
#pragma once
#include <filesystem>
#include <span>

#include "client/connection/image_file.h"
#include "client/shot/line_job.h"
#include "client/shot/session.h"

namespace caustream::shot {

// Bytes under another name, then the name.
connection::Written writeWhole(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
connection::Written writeWhole(const std::filesystem::path& file, const std::string& text);

// What a killed run left unfinished.
void removeUnfinished(const std::filesystem::path& folder);

// NAME.json of a line whose files are complete and of this key; null: it is to be drawn.
protocol::Json completeLine(const std::filesystem::path& folder, const LineJob& job);

// Writes NAME.TARGET.png, .npy and .exr, then NAME.json, which comes back.
tl::expected<protocol::Json, std::string> writeLine(const std::filesystem::path& folder, const LineJob& job, const std::vector<Drawn>& drawn,
                                                    const std::vector<Format>& formats, const protocol::Json& about);

// What the JSON says of a line beside its pictures: state, camera, scene, server.
protocol::Json aboutLine(const Session& session);

}  // namespace caustream::shot
