// SPDX-License-Identifier: MIT
#include "clock.hpp"

namespace sluice::ledger {

bool Clock::join(const Clock& other) {
    bool rose = false;
    for (Slot i = 0; i < kInside; ++i) {
        rose |= other.inside_[i] > inside_[i];
        inside_[i] = std::max(inside_[i], other.inside_[i]);
    }
    if (other.more_.size() > more_.size()) {
        more_.resize(other.more_.size());
    }
    for (std::size_t i = 0; i < other.more_.size(); ++i) {
        rose |= other.more_[i] > more_[i];
        more_[i] = std::max(more_[i], other.more_[i]);
    }
    return rose;
}

bool Clock::covers(const Clock& other) const {
    for (Slot i = 0; i < other.size(); ++i) {
        if (other.get(i) > get(i)) {
            return false;
        }
    }
    return true;
}

const Clock* Sight::find(Slot resource) const {
    const auto found =
        std::find_if(listed.begin(), listed.end(), [&](const auto& one) { return one.first == resource; });
    return found == listed.end() ? nullptr : &found->second;
}

Clock& Sight::at(Slot resource) {
    const auto found =
        std::find_if(listed.begin(), listed.end(), [&](const auto& one) { return one.first == resource; });
    return found == listed.end() ? listed.emplace_back(resource, Clock{}).second : found->second;
}

Knowledge::Knowledge(const Knowledge& other)
    : order_(other.order_), sight_(other.sight_ ? std::make_unique<Sight>(*other.sight_) : nullptr) {}

Knowledge& Knowledge::operator=(const Knowledge& other) {
    if (this != &other) {
        order_ = other.order_;
        sight_ = other.sight_ ? std::make_unique<Sight>(*other.sight_) : nullptr;
    }
    return *this;
}

void Knowledge::raise(Epoch epoch) {
    order_.raise(epoch);
    if (sight_) {
        sight_->all.raise(epoch);
    }
}

bool Knowledge::absorb(const Knowledge& other) {
    if (!sight_ && !other.sight_) {
        return order_.join(other.order_);
    }
    if (!sight_) {
        sight_ = std::make_unique<Sight>(Sight{order_, {}});
    }
    bool rose = order_.join(other.order_);
    rose |= sight_->all.join(other.visible());
    if (other.sight_) {
        for (const auto& [resource, seen] : other.sight_->listed) {
            rose |= sight_->at(resource).join(seen);
        }
    }
    settle();
    return rose;
}

bool Knowledge::absorbOrder(const Clock& other) {
    if (!sight_) {
        sight_ = std::make_unique<Sight>(Sight{order_, {}});
    }
    return order_.join(other);
}

bool Knowledge::see(Slot resource, const Clock& seen) {
    return sight_ && !sight_->all.covers(seen) && sight_->at(resource).join(seen);
}

bool Knowledge::seeAll(const Clock& seen) {
    return sight_ && sight_->all.join(seen);
}

void Knowledge::settle() {
    if (!sight_) {
        return;
    }
    auto& listed = sight_->listed;
    listed.erase(std::remove_if(listed.begin(), listed.end(),
                                [this](const auto& one) { return sight_->all.covers(one.second); }),
                 listed.end());
    if (sight_->all.covers(order_)) {
        sight_.reset();
    }
}

bool Knowledge::sees(Epoch epoch, Slot resource) const {
    if (!sight_ || sight_->all.covers(epoch)) {
        return order_.covers(epoch);
    }
    const auto* seen = sight_->find(resource);
    return seen != nullptr && seen->covers(epoch);
}

std::size_t Knowledge::bytes() const {
    std::size_t sum = order_.bytes();
    if (sight_) {
        sum += sizeof(Sight) + sight_->all.bytes() + sight_->listed.capacity() * sizeof(sight_->listed[0]);
        for (const auto& [resource, seen] : sight_->listed) {
            sum += seen.bytes();
        }
    }
    return sum;
}

}  // namespace sluice::ledger
