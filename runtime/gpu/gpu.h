// The GPU layer that stages use: Device, Buffer, Kernel, Recorder.
#pragma once
#include "runtime/gpu/device.h"
#include "runtime/gpu/recorder.h"
