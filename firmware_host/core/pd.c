#include "pd.h"

int32_t pd_torque(const struct pd *pd, int32_t position_error, int32_t velocity_error)
{
    /* Each product is below 2^62, so it is divided before they are added. */
    int64_t torque = (int64_t)pd->stiffness * position_error / 1000000 +
                     (int64_t)pd->damping * velocity_error / 1000000;
    if (torque > pd->torque_limit) {
        return pd->torque_limit;
    }
    return torque < -pd->torque_limit ? -pd->torque_limit : (int32_t)torque;
}
