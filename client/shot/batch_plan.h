// A batch's file, read and checked as far as that goes without drawing: what is to be drawn, and which lines are wrong.
#pragma once
#include <filesystem>
#include <istream>

#include "client/shot/line_job.h"

namespace caustream::shot {

struct PlanOptions {
    protocol::Json start;                  // document that patches go on; its scene may be ["file", path]
    std::vector<std::string> targets;      // of lines that name none
    std::vector<Format> formats;
    bool converge = false;                 // lines that do not say
    std::vector<std::string> passes;       // the server's
    std::filesystem::path folder;          // where the batch lies: scenes of files are named from there
};

struct BadLine {
    int number = 0;
    std::string name;  // empty: not known
    LineError error;
};

struct BatchPlan {
    std::vector<LineJob> jobs;  // in the file's order
    std::vector<BadLine> bad;
};

BatchPlan planBatch(std::istream& in, const PlanOptions& options);

}  // namespace caustream::shot
