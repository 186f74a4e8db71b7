// SPDX-License-Identifier: AGPL-3.0-or-later
#include "blackhole/method.h"

#include <cstring>
#include <iterator>

namespace blackhole {

bool find_method(const char* name, Method& method) {
	for (std::size_t i = 0; i < std::size(method_names); i++)
		if (std::strcmp(name, method_names[i]) == 0) {
			method = static_cast<Method>(i);
			return true;
		}
	return false;
}

const Integrator& integrator_of(Method method) {
	switch (method) {
	case Method::dopri5:
		return dopri5;
	case Method::rk4:
	case Method::exact:
		break;
	}
	return rk4;
}

} // namespace blackhole
