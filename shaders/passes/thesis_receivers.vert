#include "passes/camera_receivers.vert"
