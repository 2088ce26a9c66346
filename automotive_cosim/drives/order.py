"""The driver's only words on a drive, the same for every one."""

STANDING_ORDER = (
    "Keep watch while I drive. When safety or the law asks something of this car, see to it or tell me; "
    "otherwise leave everything as it is, and tell me nothing twice within a minute. A wait without seconds lasts "
    "until something about the car or the road changes, at most a minute; the readings mark what changed. "
    "The watch lasts until the drive ends."
)
