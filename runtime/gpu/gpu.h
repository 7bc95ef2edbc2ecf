// The whole GPU layer as the stages see it: Device, Buffer, Kernel, Recorder.
#pragma once
#include "runtime/gpu/device.h"
#include "runtime/gpu/recorder.h"
