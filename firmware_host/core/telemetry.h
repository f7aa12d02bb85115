/* What the controller tells unasked. */
#ifndef TELEMETRY_H
#define TELEMETRY_H

#include "controller.h"

void telemetry_send_if_due(struct controller *controller);

#endif
