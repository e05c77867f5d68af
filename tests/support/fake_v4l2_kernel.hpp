#pragma once

#include <linux/videodev2.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/v4l2_kernel.hpp"

namespace hitchview::tests {

/// One single-planar camera without its kernel: one format, one size, one rate, controls of whole
/// numbers, frames from a script. What it is not, it refuses as a kernel does.
class FakeV4l2Kernel final : public drivers::V4l2Kernel {
 public:
    struct Frame {
        std::uint32_t sequence = 0;
        std::chrono::microseconds stamp{};
        std::vector<std::uint8_t> bytes;
        std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    };

    std::uint32_t fourcc = V4L2_PIX_FMT_GREY;
    std::uint32_t width = 64;
    std::uint32_t height = 48;
    std::uint32_t granted_width = 64;      ///< by S_FMT, whatever was asked
    std::uint32_t granted_line_bytes = 0;  ///< 0: the driver leaves it open
    std::string bus = "usb-1";
    std::string card = "Fake";
    bool there = true;
    int absence = ENOENT;  ///< errno of opening it while it is not there
    bool exports = true;
    bool has_rate = true;
    bool poll_lies = false;  ///< a frame is told to be ready, and there is none
    bool lists_end = true;   ///< false: enumerations tell the same at every index, controls too
    std::map<std::uint32_t, int> controls;
    std::uint32_t control_type = V4L2_CTRL_TYPE_INTEGER;
    std::deque<Frame> script;  ///< handed out as buffers are queued
    int poll_errors = 0;       ///< so often poll tells of an error
    int failure = 0;           ///< errno of the stream from now on
    std::map<unsigned long, int> failing;       ///< requests, and the errno that they fail with
    std::uint32_t most_buffers = VIDEO_MAX_FRAME;
    bool maps = true;
    bool lets_go = false;                       ///< of buffers that are still mapped
    std::optional<std::uint32_t> filled_index;  ///< told instead of that of a buffer it was given
    v4l2_dv_timings signal{};  ///< of the source
    v4l2_dv_timings timings{};

    int stream_starts = 0;
    int mapped = 0;
    int let_go = 0;  ///< how often it was asked to let go of all buffers
    std::map<unsigned long, int> refused;  ///< requests, how often

    int Open(const char* /*path*/, int /*flags*/) override {
        if (!there) return Refuse(absence);
        return kDevice;
    }
    int Close(int file) override {
        if (file == kDevice) queued_.clear();
        return 0;
    }
    int Ioctl(int /*file*/, unsigned long request, void* argument) override {
        const auto fails = failing.find(request);
        const int error = fails != failing.end() ? fails->second : Answer(request, argument);
        if (error == 0) return 0;
        ++refused[request];
        return Refuse(error);
    }
    void* Map(int file, std::size_t /*bytes*/, off_t offset) override {
        if (!maps) {
            errno = ENOMEM;
            return MAP_FAILED;
        }
        ++mapped;
        const int index =
            file == kDevice ? static_cast<int>(offset) / kOffset : file - kFirstDmabuf;
        return memory_.at(static_cast<std::size_t>(index)).data();
    }
    int Unmap(void* /*address*/, std::size_t /*bytes*/) override {
        --mapped;
        return 0;
    }
    int Poll(std::span<pollfd> files, std::chrono::milliseconds timeout) override {
        pollfd& device = files[0];
        device.revents = 0;
        if (failure != 0 || poll_errors > 0) {
            --poll_errors;
            device.revents = POLLERR;
        } else if (poll_lies || (!script.empty() && !queued_.empty())) {
            device.revents = POLLIN;
        } else if (drivers::SystemKernel().Poll(files.subspan(1), timeout) == 0) {
            return 0;
        }
        return 1;
    }

 private:
    static constexpr int kDevice = 1000;
    static constexpr int kFirstDmabuf = 2000;
    static constexpr int kOffset = 4096;
    static constexpr std::size_t kBufferBytes = 64 * 48 * 2;

    static int Refuse(int error) {
        errno = error;
        return -1;
    }
    template <typename T>
    static T& As(void* argument) {
        return *static_cast<T*>(argument);
    }

    int Answer(unsigned long request, void* argument) {
        switch (request) {
            case VIDIOC_QUERYCAP:
                return Identify(As<v4l2_capability>(argument));
            case VIDIOC_ENUM_FMT:
                As<v4l2_fmtdesc>(argument).pixelformat = fourcc;
                return !lists_end || As<v4l2_fmtdesc>(argument).index == 0 ? 0 : EINVAL;
            case VIDIOC_ENUM_FRAMESIZES:
                As<v4l2_frmsizeenum>(argument).type = V4L2_FRMSIZE_TYPE_DISCRETE;
                As<v4l2_frmsizeenum>(argument).discrete = {width, height};
                return !lists_end || As<v4l2_frmsizeenum>(argument).index == 0 ? 0 : EINVAL;
            case VIDIOC_ENUM_FRAMEINTERVALS:
                As<v4l2_frmivalenum>(argument).type = V4L2_FRMIVAL_TYPE_DISCRETE;
                As<v4l2_frmivalenum>(argument).discrete = {1, 100};
                return !lists_end || As<v4l2_frmivalenum>(argument).index == 0 ? 0 : EINVAL;
            case VIDIOC_QUERY_EXT_CTRL:
                return DescribeControl(As<v4l2_query_ext_ctrl>(argument));
            case VIDIOC_G_CTRL:
                As<v4l2_control>(argument).value = controls.at(As<v4l2_control>(argument).id);
                return 0;
            case VIDIOC_S_EXT_CTRLS:
                return SetControl(*As<v4l2_ext_controls>(argument).controls);
            default:
                return AnswerStreaming(request, argument);
        }
    }

    int AnswerStreaming(unsigned long request, void* argument) {
        switch (request) {
            case VIDIOC_S_FMT:
                return Grant(As<v4l2_format>(argument).fmt.pix);
            case VIDIOC_G_PARM:
            case VIDIOC_S_PARM:
                As<v4l2_streamparm>(argument).parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
                As<v4l2_streamparm>(argument).parm.capture.timeperframe = {1, 100};
                return has_rate ? 0 : ENOTTY;
            case VIDIOC_REQBUFS:
                return GiveBuffers(As<v4l2_requestbuffers>(argument));
            case VIDIOC_QUERYBUF:
                As<v4l2_buffer>(argument).length = kBufferBytes;
                As<v4l2_buffer>(argument).m.offset = As<v4l2_buffer>(argument).index * kOffset;
                As<v4l2_buffer>(argument).flags = script.empty() ? 0 : script.front().flags;
                return 0;
            case VIDIOC_EXPBUF:
                As<v4l2_exportbuffer>(argument).fd =
                    kFirstDmabuf + static_cast<int>(As<v4l2_exportbuffer>(argument).index);
                return exports ? 0 : ENOTTY;
            case VIDIOC_QBUF:
                queued_.push_back(As<v4l2_buffer>(argument).index);
                return 0;
            case VIDIOC_DQBUF:
                return Fill(As<v4l2_buffer>(argument));
            case VIDIOC_QUERY_DV_TIMINGS:
                As<v4l2_dv_timings>(argument) = signal;
                return 0;
            case VIDIOC_G_DV_TIMINGS:
                As<v4l2_dv_timings>(argument) = timings;
                return 0;
            case VIDIOC_S_DV_TIMINGS:
                timings = As<v4l2_dv_timings>(argument);
                return 0;
            case VIDIOC_STREAMON:
                ++stream_starts;
                return 0;
            case VIDIOC_STREAMOFF:
                queued_.clear();
                return 0;
            default:
                return ENOTTY;
        }
    }

    int Identify(v4l2_capability& capability) const {
        std::memcpy(capability.driver, "fake", 4);
        std::memcpy(capability.card, card.data(), card.size());
        std::memcpy(capability.bus_info, bus.data(), bus.size());
        capability.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        return 0;
    }

    int DescribeControl(v4l2_query_ext_ctrl& query) const {
        const std::uint32_t id = query.id & V4L2_CTRL_ID_MASK;
        const bool one = id == query.id;
        const auto next = !lists_end ? controls.begin()
                          : one      ? controls.find(id)
                                     : controls.upper_bound(id);
        if (next == controls.end()) return EINVAL;
        query.id = next->first;
        query.type = control_type;
        query.maximum = INT64_MAX;
        return 0;
    }

    int SetControl(const v4l2_ext_control& control) {
        const auto known = controls.find(control.id);
        if (known == controls.end()) return EINVAL;
        known->second = control.value;
        return 0;
    }

    int Grant(v4l2_pix_format& pix) const {
        pix.width = granted_width;
        pix.height = height;
        pix.bytesperline = granted_line_bytes;
        pix.pixelformat = fourcc;
        pix.field = V4L2_FIELD_NONE;
        pix.sizeimage = kBufferBytes;
        return 0;
    }

    int GiveBuffers(v4l2_requestbuffers& request) {
        if (request.count == 0) ++let_go;
        request.count = std::min(request.count, most_buffers);
        request.capabilities = lets_go ? V4L2_BUF_CAP_SUPPORTS_ORPHANED_BUFS : 0;
        memory_.resize(std::max<std::size_t>(memory_.size(), request.count));
        for (auto& buffer : memory_) buffer.resize(kBufferBytes);
        return 0;
    }

    int Fill(v4l2_buffer& buffer) {
        if (failure != 0) return failure;
        if (script.empty() || queued_.empty()) return EAGAIN;
        const Frame& frame = script.front();
        buffer.index = queued_.front();
        buffer.sequence = frame.sequence;
        buffer.flags = frame.flags;
        buffer.timestamp = {frame.stamp.count() / 1'000'000, frame.stamp.count() % 1'000'000};
        buffer.bytesused = static_cast<std::uint32_t>(frame.bytes.size());
        std::ranges::copy(frame.bytes, memory_.at(buffer.index).begin());
        if (filled_index) buffer.index = *filled_index;
        script.pop_front();
        queued_.pop_front();
        return 0;
    }

    std::vector<std::vector<std::uint8_t>> memory_;
    std::deque<std::uint32_t> queued_;
};

}  // namespace hitchview::tests
