"""A job, whatever it makes: the call of its stage, its log, progress, the modules it depends on."""
