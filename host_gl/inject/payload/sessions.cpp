// SPDX-License-Identifier: MIT
#include "payload/sessions.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace sluice::inject {

Session* Sessions::claim(const CurrentContext& current) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
        const CurrentContext& of = entry.session->identity();
        return of.api == current.api && of.context == current.context && !entry.session->ended();
    });
    if (found == entries_.end()) {
        return nullptr;
    }
    found->session->own(std::this_thread::get_id());
    return found->session.get();
}

Session& Sessions::add(std::unique_ptr<Session> made) {
    made->own(std::this_thread::get_id());
    const std::lock_guard lock(mutex_);
    entries_.push_back({std::move(made)});
    return *entries_.back().session;
}

bool Sessions::release(Session& session) {
    const std::lock_guard lock(mutex_);
    if (session.owner() != std::this_thread::get_id()) {
        return false;  // its context has become current elsewhere, by a way that nobody saw
    }
    session.own({});
    const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry& each) { return each.session.get() == &session; });
    if (session.ended() || entry == entries_.end() || !entry->doomed) {
        return false;
    }
    session.retire();
    return true;
}

std::vector<Session*> Sessions::retire(const std::function<bool(const CurrentContext&)>& destroyed) {
    std::vector<Session*> mine;
    const std::lock_guard lock(mutex_);
    for (Entry& entry : entries_) {
        Session& session = *entry.session;
        if (session.ended() || !destroyed(session.identity())) {
            continue;
        }
        if (session.owner() != std::thread::id{} && session.owner() != std::this_thread::get_id()) {
            entry.doomed = true;
            continue;
        }
        mine.push_back(&session);
        session.own({});
        session.retire();
    }
    return mine;
}

void Sessions::visit(const std::function<void(Session&, bool free)>& what) {
    const std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_) {
        const std::thread::id owner = entry.session->owner();
        what(*entry.session, owner == std::thread::id{} || owner == std::this_thread::get_id());
    }
}

}  // namespace sluice::inject
