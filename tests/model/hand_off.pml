/* SPDX-License-Identifier: MIT
 * The hand-off of docs/protocol.md, for spin. scripts/model lists the configurations and the broken variants; README.md
 * says how to run one. A word in capitals behind #if or #ifdef is given with -D.
 *
 *   SETS, FRAMES      image sets in the ring, host frames in a run
 *   BRIDGED           the timeline (native without it)
 *   SKIPS             the host may leave a submitted frame without composite
 *   FAILS             submit_frame may fail; native: so may the recording of a signal or of a wait
 *   TIMEOUTS          every wait of a CPU may time out, at any moment
 *   VK_LOSS, GL_LOSS  the renderer's device, or the GL context, may be lost between any two steps
 *   RESIZE            the host may resize once, before any frame
 *   BREAK_...         one line of the protocol left out or turned round; spin has to find it
 */
#ifndef SETS
#define SETS 2
#endif
#ifndef FRAMES
#define FRAMES 4
#endif
#define TORN 255                 /* the version of an image that somebody has begun to write */
#define SET(k) (((k) - 1) % SETS)
#define COMMANDS (6 * FRAMES + 1) /* a frame records six at most: recording never blocks, as if the driver took all */

mtype:op = { Capture, Signal, Wait, Composite, Present };
mtype:result = { Ok, Failed, TimedOut, DeviceLost };
mtype:step = { Idle, Capturing, ToRenderer, ToHost }; /* of sluice::HandOff */

/* What both sides share: two counters, and what each has yet to execute, in order. The head stays until it has run. */
byte host_value, renderer_value;
chan gl = [COMMANDS] of { mtype:op, byte };
chan vk = [SETS + 1] of { byte };
byte fence;                      /* bridged: the last GL fence that has arrived */
chan promises = [2 * FRAMES + 1] of { byte };
byte kept, promised;             /* bridged: BridgeThread's, by value */
bit bridge_error, bridge_stop, bridge_done;
bit vk_lost, gl_lost, gl_stands; /* gl_stands: at a wait whose value can never come */

/* Ghosts. Nothing that decides reads them; they are set for the duration of an access, whatever the counters say. */
bit gl_uses[SETS], vk_uses[SETS];
byte gbuffer[SETS], fluid[SETS]; /* the frame that an image holds */
byte presented;                  /* frames of the host that its GL stream has ended */

/* ------------------------------------------------------------------------------------------- GL command stream -- */
#define SIGNAL_HOST(v) assert((v) > host_value /* monotonic: host */); host_value = v

active proctype GlStream() {
    mtype:op what;
    byte v;
end_idle:
    do
    :: atomic { !gl_lost && nempty(gl) -> gl?<what, v>;
            if
            :: what == Capture ->
                assert(!vk_uses[SET(v)] /* overlap: capture */);
                gl_uses[SET(v)] = 1;
                gbuffer[SET(v)] = TORN
            :: what == Composite ->
                assert(!vk_uses[SET(v)] /* overlap: composite */);
                assert(fluid[SET(v)] == v /* content: composite begins */);
                gl_uses[SET(v)] = 1
            :: what == Wait ->
                if
                :: renderer_value >= v
                :: gl_lost -> goto dead
#ifndef BREAK_NO_PROVISO
                :: vk_lost && renderer_value < v -> gl_stands = 1; goto dead
#endif
                fi
            :: what == Signal ->
#ifdef BRIDGED
                fence = v
#else
                SIGNAL_HOST(v)
#endif
            :: what == Present -> presented++
            fi;
            if
            :: what == Capture || what == Composite
            :: else -> gl?what, v; what = 0; v = 0
            fi
        };
        atomic {
            if
            :: what == 0
            :: what != 0 && gl_lost -> goto dead
            :: what != 0 && !gl_lost ->
                if
                :: what == Capture -> gbuffer[SET(v)] = v
                :: else -> assert(fluid[SET(v)] == v /* content: composite ends */)
                fi;
                gl_uses[SET(v)] = 0;
                gl?what, v; what = 0; v = 0
            fi
        }
    :: atomic { gl_lost -> goto dead }
    od;
dead:
    what = 0; v = 0
}

/* ---------------------------------------------------------------------------------------------- Vulkan's queue -- */
active proctype Queue() {
    byte k;
end_idle:
    do
    :: atomic { !vk_lost && nempty(vk) -> vk?<k>;
            /* Begins: takes the set once the host's value is there. */
            if
            :: vk_lost -> goto dead
#ifdef BREAK_NO_RENDERER_WAIT
            :: !vk_lost ->
#else
            :: !vk_lost && host_value >= 2 * k - 1 ->
#endif
                /* A lost GL context writes no more, and its bridge lets the renderer go on with what is there. */
                assert(!gl_uses[SET(k)] || gl_lost /* overlap: renderer */);
                assert(gbuffer[SET(k)] == k || gl_lost /* content: renderer begins */);
                vk_uses[SET(k)] = 1;
                fluid[SET(k)] = TORN
            fi
        };
#ifdef BREAK_EARLY_RENDERER_SIGNAL
        renderer_value = k;
#endif
        atomic {
            if
            :: vk_lost -> goto dead
            :: else ->
                assert(gbuffer[SET(k)] == k || gl_lost /* content: renderer ends */);
                fluid[SET(k)] = gbuffer[SET(k)];
                vk_uses[SET(k)] = 0
            fi
        };
        atomic {
            if
            :: vk_lost -> goto dead
            :: else ->
#ifndef BREAK_EARLY_RENDERER_SIGNAL
                assert(k > renderer_value /* monotonic: renderer */);
                renderer_value = k;
#endif
                vk?k;
                k = 0
            fi
        }
    :: atomic { vk_lost -> goto dead }
    od;
dead:
    k = 0
}

/* ---------------------------------------------------------------------------------- the bridge, and the losses -- */
#ifdef BRIDGED
active proctype Bridge() {
    byte v;
    do
    :: atomic { nempty(promises) -> promises?<v> };
        if
#ifdef BREAK_BRIDGE_DOES_NOT_WAIT
        :: true
#else
        :: fence >= v
#endif
        :: gl_lost -> bridge_error = 1
        fi;
        if
        :: atomic { !vk_lost -> SIGNAL_HOST(v) }
        :: vk_lost -> bridge_error = 1
        fi;
        atomic { kept = v; promises?_ }
    :: atomic { bridge_stop && empty(promises) -> break }
    od;
    bridge_done = 1
}
#endif

/* A loss comes between any two steps. Runs in which none comes are those of the rows without VK_LOSS and GL_LOSS. */
#ifdef VK_LOSS
active proctype VkLoss() { vk_lost = 1 }
#endif
#ifdef GL_LOSS
active proctype GlLoss() { gl_lost = 1 }
#endif

/* --------------------------------------------------------------------------- the host's thread: RendererLife -- */
hidden byte i;

inline know_reached(v) {
    if
    :: v > reached -> reached = v
    :: else
    fi;
    for (i : 0 .. SETS - 1) {
        if
        :: owed[i] <= reached -> owed[i] = 0
        :: else
        fi
    }
}

/* HostTimeline::signal */
inline signal(v) {
#ifdef BRIDGED
    if
    :: atomic { bridge_error -> bridge_error = 0; result = Failed }
    :: atomic { !bridge_error -> gl!Signal(v); promises!v; promised = v; result = Ok }
    fi
#else
    if
    :: atomic { gl!Signal(v); result = Ok }
#ifdef FAILS
    :: result = Failed
#endif
    fi
#endif
#ifdef BREAK_NO_FLUSH
    ; flushed = 0
#endif
}

/* HostTimeline::wait for the renderer's value v */
inline wait(v) {
    assert(!known /* no wait after the loss is known */);
#ifdef BRIDGED
    assert(flushed /* nobody waits for what was not flushed */);
    if
    :: !bridge_error && (kept >= 2 * v - 1 || kept == promised) -> result = Ok
    :: bridge_error -> result = DeviceLost
#ifdef TIMEOUTS
    :: result = TimedOut
#endif
    fi;
    if
    :: result == Ok ->
        if
        :: renderer_value >= v
        :: vk_lost -> result = DeviceLost
#ifdef TIMEOUTS
        :: result = TimedOut
#endif
        :: bridge_error && renderer_value < v
        fi
    :: else
    fi;
    atomic {
        if
        :: bridge_error -> bridge_error = 0; result = DeviceLost
        :: else
        fi
    }
#else
    if
    :: atomic { gl!Wait(v); result = Ok }
#ifdef FAILS
    :: result = Failed
#endif
    fi
#endif
}

inline note_loss() {
    if
    :: result == DeviceLost -> known = 1
    :: else
    fi
}

/* FrameRing::waitForSlot, then record and vkQueueSubmit2 */
inline submit_frame(k) {
    assert(flushed /* nobody waits for what was not flushed */);
    result = Ok;
    if
    :: slot[SET(k)] != 0 ->
        if
        :: atomic { renderer_value >= slot[SET(k)] -> slot[SET(k)] = 0 }
        :: vk_lost -> result = DeviceLost
#ifdef TIMEOUTS
        :: result = Failed
#else
        :: gl_lost -> result = Failed
#endif
        fi
    :: else
    fi;
    if
    :: result == Ok ->
        if
        :: atomic { vk!k; slot[SET(k)] = k; last = k }
        :: vk_lost -> result = DeviceLost
#ifdef FAILS
        :: result = Failed
#endif
        fi
    :: else
    fi
}

/* finishGl */
inline finish_gl() {
    if
#ifndef BRIDGED
    :: known -> skip
#endif
#ifdef BRIDGED
    :: empty(gl) || gl_lost
#else
    :: !known && (empty(gl) || gl_lost)
    :: !known && gl_stands -> goto hangs /* the proviso: nobody has reported the loss yet */
#endif
    fi
}

/* RendererTimeline::drain. The grace ends only when nothing can move any more: GL has ended its work or is lost, and the
 * bridge has kept what it promised. */
inline drain() {
    if
    :: last == 0 || renderer_value >= last || vk_lost
#ifdef BREAK_NO_GRACE
    :: host_value < 2 * last - 1 -> host_value = 2 * last - 1
#else
    :: atomic { (empty(gl) || gl_lost) && empty(promises) && host_value < 2 * last - 1 -> host_value = 2 * last - 1 }
#endif
    fi;
    empty(vk) || vk_lost /* vkQueueWaitIdle */
}

active proctype Host() {
    /* ImageSets::Set and sluice::HandOff, per set; what HandOff would refuse is an assertion here. */
    byte owed[SETS], owed_renderer[SETS], hand_off_frame[SETS];
    mtype:step hand_off[SETS];
    byte reached;
    byte slot[SETS];         /* FrameRing: the frame that still runs, or may */
    byte last;               /* RendererTimeline: the last frame that was submitted */
    mtype:result result;
    bit known;               /* RendererLife::lost_ */
    bit flushed = 1;         /* every signal that was recorded is on its way */
    byte tick = 1, next = 1, k;
    byte was_frame, was_owed;
    mtype:step was;
    bit composable, usable = 1, resized;
    atomic {
        for (i : 0 .. SETS - 1) {
            hand_off[i] = Idle
        }
    };
    do
    :: tick <= FRAMES ->
#ifdef RESIZE
        if
        :: !resized ->
            resized = 1;
#ifndef BREAK_RESIZE_WITHOUT_FINISH
            finish_gl();
#endif
            composable = 0;
#ifndef BREAK_RESIZE_WITHOUT_DRAIN
            drain();
#endif
            if
            :: vk_lost -> usable = 0
            :: !vk_lost ->
                atomic {
                    for (i : 0 .. SETS - 1) {
                        assert(!gl_uses[i] || gl_lost /* overlap: resize and GL */);
                        assert(!vk_uses[i] || vk_lost /* overlap: resize and renderer */);
                        gbuffer[i] = 0; fluid[i] = 0;
                        hand_off[i] = Idle; hand_off_frame[i] = 0; owed[i] = 0; owed_renderer[i] = 0; slot[i] = 0
                    };
                }
            fi
        :: true
        fi;
#endif
        /* submit */
        composable = 0;
        if
#ifdef BREAK_LOSS_IS_IGNORED
        :: !usable -> goto present
#else
        :: known || !usable -> goto present
#endif
        :: else
        fi;
        k = next;
        result = Ok;
#ifdef BREAK_WAIT_BEFORE_PROMISE
        wait(k);
#endif
        if
        :: owed[SET(k)] != 0 ->
#if defined(BREAK_NO_CAPTURE_WAIT)
            skip;
#elif defined(BREAK_REUSE_ONE_TOO_EARLY)
            if
            :: owed[SET(k)] > 1 -> wait(owed[SET(k)] - 1)
            :: else
            fi;
#elif defined(BREAK_RETRY_FOREVER)
            do
            :: wait(owed[SET(k)]); if :: result == Ok -> break :: else fi
            od;
#else
            wait(owed[SET(k)]);
#endif
            if
            :: result == Ok -> atomic { was_owed = owed[SET(k)]; know_reached(was_owed) }
            :: else -> note_loss(); goto present
            fi
        :: else
        fi;
        d_step {
            was = hand_off[SET(k)]; was_frame = hand_off_frame[SET(k)]; was_owed = owed_renderer[SET(k)];
#ifndef BREAK_NUMBER_USED_AGAIN /* HandOff would refuse it; the counters are to show it by themselves */
            assert(k > hand_off_frame[SET(k)] && (was == Idle || was == ToHost) /* HandOff: acquire in order */);
#endif
            assert(reached >= owed_renderer[SET(k)] /* HandOff: acquire needs the owed value */);
            hand_off[SET(k)] = Capturing; hand_off_frame[SET(k)] = k; owed_renderer[SET(k)] = 0
        };
        atomic { /* what is recorded together may still be executed apart */
#ifdef BREAK_EARLY_HOST_SIGNAL
            signal(2 * k - 1);
            gl!Capture(k)
#else
            gl!Capture(k);
            signal(2 * k - 1)
#endif
        };
        if
        :: result != Ok -> /* cancelCapture: the number may be used again */
            d_step {
                hand_off[SET(k)] = was; hand_off_frame[SET(k)] = was_frame; owed_renderer[SET(k)] = was_owed
            };
            goto present
        :: else
        fi;
#ifndef BREAK_NUMBER_USED_AGAIN
        next = k + 1;
#endif
        hand_off[SET(k)] = ToRenderer;
        submit_frame(k);
        if
        :: result != Ok ->
            note_loss();
            hand_off[SET(k)] = Idle; /* abandon */
#ifdef BREAK_FAILED_FRAME_IS_OWED
            owed[SET(k)] = k; owed_renderer[SET(k)] = k;
#endif
            goto present
        :: else
        fi;
#ifdef BREAK_NUMBER_USED_AGAIN
        next = k + 1;
#endif
        d_step {
            hand_off[SET(k)] = ToHost;
            owed[SET(k)] = k; owed_renderer[SET(k)] = k; /* promised */
            composable = 1
        };
        /* composite */
        if
#ifdef SKIPS
        :: composable = 0
#endif
#ifdef VK_LOSS
        :: vk_lost -> known = 1; composable = 0 /* FluidHost::stats was asked, and said so */
#endif
        :: true
        fi;
        if
        :: composable ->
#ifdef BREAK_NO_COMPOSITE_WAIT
            result = Ok;
#else
            wait(k);
#endif
            if
            :: result == Ok ->
                atomic {
                    know_reached(k);
                    assert(hand_off[SET(k)] == ToHost && reached >= k /* HandOff: composite in order */);
                    gl!Composite(k);
                    signal(2 * k); /* a failure here is only told */
                    hand_off[SET(k)] = Idle
                }
            :: else ->
                note_loss()
#ifdef BREAK_TIMEOUT_FREES_THE_SET
                ; hand_off[SET(k)] = Idle; owed[SET(k)] = 0; owed_renderer[SET(k)] = 0
#endif
            fi
        :: else
        fi;
present:
        atomic { gl!Present(0); tick++; result = Ok; k = 0; was = Idle; was_frame = 0; was_owed = 0; composable = 0 }
    :: else -> break
    od;
    /* The destructor: GL has ended, the bridge has drained, the renderer ends. */
    finish_gl();
    bridge_stop = 1;
#ifdef BRIDGED
    bridge_done;
#endif
    drain();
    /* A ghost's look: every frame of the host has ended on the GL stream, but for the two ways that are named. */
    empty(gl) || gl_lost || gl_stands;
    d_step {
        assert(presented == FRAMES || gl_lost || gl_stands /* every frame of the host ends */);
        assert(!gl_stands || vk_lost /* GL stands for a loss only */);
        for (i : 0 .. SETS - 1) {
            assert((!gl_uses[i] || gl_lost) && (!vk_uses[i] || vk_lost) /* nothing is left in use */)
        }
    };
#ifdef BREAK_WITNESS
    assert(renderer_value != FRAMES || fluid[SET(FRAMES)] != FRAMES /* witness */);
#endif
    goto ended;
hangs:
#ifndef BREAK_NO_PROVISO
end_hangs:
#endif
    vk_lost && false;
ended:
    skip
}
