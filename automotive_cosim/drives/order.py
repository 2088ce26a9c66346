"""What the driver says on a drive: one order, and one answer to any question."""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.contracts.given import Language, Order
from automotive_cosim.tasking.dialogue import NEUTRAL

STANDING_ORDERS: Mapping[Language, str] = {
    Language.ENGLISH: (
        "Keep watch while I drive. When safety or the law asks something of this car, see to it or tell me; "
        "otherwise leave everything as it is, and tell me nothing twice within a minute. A wait without "
        "seconds lasts until something about the car or the road changes, at most a minute; the readings mark"
        " what changed. The watch lasts until the drive ends."
    ),
    Language.FRENCH: (
        "Veille pendant que je conduis. Si la sécurité ou la loi exige quelque chose de cette voiture, "
        "occupe-t'en ou préviens-moi ; sinon, ne touche à rien, et ne me dis rien deux fois en une minute."
        " Une attente sans durée se termine dès que quelque chose change, au plus tard après une minute ; ce"
        " qui a changé est marqué dans les mesures. Veille jusqu'à la fin du trajet."
    ),
    Language.GERMAN: (
        "Pass auf, während ich fahre. Wenn die Sicherheit oder das Gesetz etwas von diesem Auto verlangt, "
        "kümmere dich darum oder sag mir Bescheid; sonst lass alles, wie es ist, und sag mir nichts zweimal "
        "innerhalb einer Minute. Wartest du ohne Zeitangabe, dann nur, bis sich etwas ändert, höchstens eine "
        "Minute; was sich geändert hat, ist bei den Messwerten markiert. Pass auf, bis die Fahrt zu Ende ist."
    ),
    Language.JAPANESE: (
        "運転中、見張っていて。安全のためや法律上、この車に必要なことがあれば、対応するか知らせて。"
        "それ以外はそのままにして、同じことを1分以内に二度言わないで。秒数を決めない待機は何かが変わるまで、"
        "長くて1分。変わったものは計測値に印が付く。運転が終わるまで頼む。"
    ),
}
"""In each language; each fits into the observation space."""
ORDERS_WITH_ERRANDS: Mapping[Language, str] = {
    Language.ENGLISH: (
        "Keep watch while I drive. When safety or the law asks something of this car, see to it or tell me. If "
        "one of us asks you for something on the way, do that too, safety first; where I say no, leave it. "
        "Otherwise leave everything as it is, and tell me nothing twice within a minute. A wait without seconds "
        "lasts until something changes, at most a minute; the readings mark what changed."
    ),
    Language.FRENCH: (
        "Veille pendant que je conduis. Si la sécurité ou la loi exige quelque chose de cette voiture, "
        "occupe-t'en ou préviens-moi. Si l'un de nous te demande quelque chose, fais-le aussi, la sécurité "
        "d'abord ; si je dis non, n'y touche pas. Sinon, laisse tout en l'état, et ne me dis rien deux fois en une "
        "minute. Une attente sans durée se termine quand quelque chose change, au plus tard après une minute."
    ),
    Language.GERMAN: (
        "Pass auf, während ich fahre. Wenn die Sicherheit oder das Gesetz etwas von diesem Auto verlangt, kümmere "
        "dich darum oder sag mir Bescheid. Bittet dich einer von uns um etwas, tu auch das, Sicherheit geht vor; "
        "sage ich nein, lass es. Sonst lass alles, wie es ist, und sag mir nichts zweimal innerhalb einer Minute. "
        "Wartest du ohne Zeitangabe, dann nur, bis sich etwas ändert, höchstens eine Minute."
    ),
    Language.JAPANESE: (
        "運転中、見張っていて。安全のためや法律上、この車に必要なことがあれば、対応するか知らせて。"
        "誰かに頼まれたことも、安全を優先してやって。だめと言ったことはしないで。"
        "それ以外はそのままにして、同じことを1分以内に二度言わないで。秒数なしの待機は変化があるまで、長くて1分。"
    ),
}
"""The order on a drive on which people aboard ask for things as well."""
PLAIN_ORDERS: Mapping[Language, tuple[str, str]] = {
    Language.ENGLISH: (
        "Keep us safe and legal, and let me drive.",
        "If one of us asks you for something, do it too.",
    ),
    Language.FRENCH: (
        "Fais que tout reste sûr et légal, et laisse-moi conduire.",
        "Si l'un de nous te demande quelque chose, fais-le aussi.",
    ),
    Language.GERMAN: (
        "Sorg dafür, dass alles sicher und erlaubt bleibt, und lass mich fahren.",
        "Bittet dich einer von uns um etwas, tu auch das.",
    ),
    Language.JAPANESE: ("安全と法律を守れるように頼む。運転は任せて。", "誰かに頼まれたこともやって。"),
}
"""The plain order, and what it adds where people aboard ask for things as well."""


def ordered(order: Order, language: Language, *, with_errands: bool) -> str:
    """What the driver says at departure. The thresholds of ``full`` stand in the prompt, not in his words."""
    if order is Order.PLAIN:
        watch, errands = PLAIN_ORDERS[language]
        return f"{watch} {errands}" if with_errands else watch
    return (ORDERS_WITH_ERRANDS if with_errands else STANDING_ORDERS)[language]


ANSWERS: Mapping[Language, str] = {
    Language.ENGLISH: NEUTRAL,
    Language.FRENCH: "Tu en sais autant que moi. Fais au mieux.",
    Language.GERMAN: "Ich weiß auch nicht mehr als du. Mach, was du für richtig hältst.",
    Language.JAPANESE: "こっちにもそれ以上は分からない。いいと思うようにして。",
}
"""The answer to a question."""
