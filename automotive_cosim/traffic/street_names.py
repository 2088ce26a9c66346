"""What streets are commonly called, by language: after trees, trades, saints, neighbours and poets, as in any town.

Languages with scripts of their own are in Latin letters, as on their bilingual signs. Lists are our own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

ENGLISH = "en"


@dataclass(frozen=True, slots=True)
class StreetWords:
    """What streets are called in one language, as in "Mill Lane"."""

    kinds: tuple[str, ...]
    """As in ``"{} Lane"``."""
    names: tuple[str, ...]
    """As in ``"Mill"``."""


def _names(text: str) -> tuple[str, ...]:
    return tuple(" ".join(name.split()) for name in text.split(","))


LANGUAGES: Mapping[str, StreetWords] = {
    ENGLISH: StreetWords(
        ("{} Street", "{} Lane", "{} Drive", "{} Close"),
        _names(
            """
            Church, Station, Mill, Park, Victoria, Albert, Kings, Queens, Chapel, Bridge, Market,
            North, South, West, East, Grange, Manor, Elm, Oak, Chestnut, Maple, Orchard, Meadow,
            Garden, Spring, Hill, Castle, Green, George, William, York, Windsor, Richmond,
            Cambridge, Oxford, Stanley, School, Rectory, Springfield, Holly
            """
        ),
    ),
    "fr": StreetWords(
        ("Rue {}", "Allée {}", "Chemin {}", "Impasse {}"),
        _names(
            """
            de la Gare, de l'Église, Victor Hugo, Jean Jaurès, Pasteur, du Moulin, des Écoles, de
            la République, de la Mairie, Jules Ferry, Gambetta, des Lilas, du Château, de la
            Fontaine, des Tilleuls, Émile Zola, de la Liberté, du Stade, des Acacias, de Verdun,
            Voltaire, de la Paix, du Lavoir, des Jardins, Saint-Martin, Saint-Jean, du Général de
            Gaulle, Jean Moulin, Carnot, des Peupliers, de l'Europe, des Roses, du Cimetière,
            Molière, de la Forge, des Marronniers, Pierre Curie, de la Poste, du Pont, Lamartine
            """
        ),
    ),
    "de": StreetWords(
        ("{}straße", "{}weg", "{}gasse", "{}ring"),
        _names(
            """
            Bahnhof, Haupt, Schul, Garten, Kirch, Linden, Birken, Wald, Berg, Dorf, Brücken,
            Mühlen, Post, Wiesen, Eichen, Buchen, Rosen, Feld, Goethe, Schiller, Mozart,
            Beethoven, Friedhof, Industrie, Ahorn, Markt, Schloss, Brunnen, Bach, Sonnen,
            Kastanien, Tannen, Jahn, Lerchen, Amsel, Tal, Burg, Mittel, Nord, Süd
            """
        ),
    ),
    "es": StreetWords(
        ("Calle {}", "Travesía {}", "Camino {}", "Pasaje {}"),
        _names(
            """
            Mayor, de la Constitución, de la Iglesia, Real, Nueva, San Juan, San José, Santa
            María, del Carmen, Cervantes, del Sol, de la Fuente, de las Flores, de la Paz, del
            Prado, San Antonio, de los Olivos, de la Estación, del Río, de los Álamos, Miguel
            Hernández, de la Libertad, Colón, San Pedro, del Pozo, de las Eras, Isabel la
            Católica, de la Rosa, del Molino, de los Naranjos, San Miguel, de la Luna, Lope de
            Vega, de la Cruz, del Castillo, Rosalía de Castro, del Horno, de la Huerta, San Roque,
            Goya
            """
        ),
    ),
    "it": StreetWords(
        ("Via {}", "Vicolo {}", "Strada {}", "Largo {}"),
        _names(
            """
            Roma, Garibaldi, Mazzini, Dante, Verdi, Cavour, Marconi, Matteotti, Manzoni, Leopardi,
            Gramsci, della Stazione, del Mulino, San Rocco, San Martino, Vittorio Veneto, Galileo
            Galilei, Leonardo da Vinci, dei Tigli, delle Rose, della Libertà, Pascoli, Carducci,
            Puccini, Rossini, Trieste, Trento, Milano, Torino, Venezia, del Castello, della
            Chiesa, Colombo, Volta, Petrarca, Foscolo, degli Ulivi, della Pace, Piave, Bellini
            """
        ),
    ),
    "pt": StreetWords(
        ("Rua {}", "Travessa {}", "Largo {}", "Beco {}"),
        _names(
            """
            da Igreja, da Liberdade, do Comércio, de São João, da Estação, das Flores, da
            República, do Sol, de Santo António, da Escola, dos Bombeiros, Camões, do Moinho, da
            Fonte, da Paz, das Oliveiras, de São Pedro, do Rio, da Saudade, da Boavista, do Carmo,
            dos Pinheiros, da Alegria, do Outeiro, de Santa Maria, do Castelo, das Laranjeiras, do
            Norte, da Praia, dos Combatentes, Eça de Queirós, da Ponte, do Mercado, das Amoreiras,
            de São José, do Forno, da Cruz, dos Lavradores, do Poço, da Misericórdia
            """
        ),
    ),
    "nl": StreetWords(
        ("{}straat", "{}laan", "{}pad", "{}hof"),
        _names(
            """
            Kerk, Molen, Stations, School, Dorps, Juliana, Beatrix, Wilhelmina, Emma, Oranje,
            Eiken, Beuken, Linden, Kastanje, Wilgen, Berken, Nieuw, Raadhuis, Markt, Park, Prins
            Hendrik, Rembrandt, Vondel, Zonnebloem, Tulpen, Rozen, Meidoorn, Haven, Brink, Koning,
            Burgemeester, Populieren, Esdoorn, Merel, Vink, Leeuwerik, Industrie, Hoog,
            Nachtegaal, Sport
            """
        ),
    ),
    "pl": StreetWords(
        ("Ulica {}", "Zaułek {}", "Droga {}", "Plac {}"),
        _names(
            """
            Polna, Leśna, Słoneczna, Krótka, Szkolna, Ogrodowa, Lipowa, Brzozowa, Łąkowa,
            Kwiatowa, Kościelna, Sosnowa, Zielona, Parkowa, Akacjowa, Kolejowa, Mickiewicza,
            Sienkiewicza, Słowackiego, Kopernika, Kościuszki, Chopina, Reymonta, Konopnickiej,
            Dworcowa, Młyńska, Spacerowa, Wiosenna, Różana, Klonowa, Jana Pawła II, Piłsudskiego,
            Cicha, Górna, Nowa, Rzeczna, Cmentarna, Wiejska, Sportowa, Wierzbowa
            """
        ),
    ),
    "tr": StreetWords(
        ("{} Sokağı", "{} Caddesi", "{} Yolu", "{} Çıkmazı"),
        _names(
            """
            Atatürk, Cumhuriyet, İstiklal, Gazi, İnönü, Fatih, Mevlana, Zafer, Barış, Lale, Gül,
            Menekşe, Çınar, Okul, Cami, Değirmen, Bahçe, Çarşı, Kavak, Yunus Emre, Mimar Sinan,
            Hürriyet, Karanfil, Papatya, Zeytin, Söğüt, Selvi, Kemer, Çeşme, Köprü, Akasya,
            Ihlamur, Defne, Güneş, Yıldız, Şehitler, Namık Kemal, Ziya Gökalp, İstasyon, Orhan
            Gazi
            """
        ),
    ),
    "sv": StreetWords(
        ("{}gatan", "{}vägen", "{}stigen", "{}gränd"),
        _names(
            """
            Stor, Kyrko, Skol, Järnvägs, Kungs, Drottning, Björk, Ek, Tall, Gran, Skogs, Ängs,
            Kvarn, Sjö, Strand, Berg, Nygårds, Storgårds, Park, Trädgårds, Industri, Hamn, Norra,
            Södra, Västra, Östra, Linné, Rönn, Lind, Ask, Solros, Blåbärs, Lingon, Hallon, Smed,
            Fågel, Lärk, Dal, Ås, Bruks
            """
        ),
    ),
    "ja": StreetWords(
        ("{} Dori", "{} Michi", "{} Koji", "{} Zaka"),
        _names(
            """
            Sakura, Chuo, Ekimae, Honmachi, Showa, Midori, Aoba, Hikari, Asahi, Miyuki, Sumiyoshi,
            Yayoi, Kotobuki, Sakae, Izumi, Matsuba, Momiji, Tsubaki, Ume, Take, Higashi, Nishi,
            Minami, Kita, Shinmachi, Teramachi, Daiku, Kajiya, Ginza, Hachiman, Inari, Tenjin,
            Shiroyama, Kawabata, Hamabe, Mizuho, Fuji, Nakamachi, Wakaba, Heiwa
            """
        ),
    ),
    "zh": StreetWords(
        ("{} Lu", "{} Jie", "{} Xiang", "{} Hutong"),
        _names(
            """
            Zhongshan, Renmin, Jiefang, Jianshe, Xinhua, Heping, Guangming, Wenhua, Xueyuan,
            Gongyuan, Beijing, Nanjing, Shanghai, Dongfeng, Chaoyang, Changjiang, Huanghe,
            Taishan, Kunlun, Yingbin, Huanghai, Jinxiu, Changchun, Tuanjie, Youyi, Xingfu,
            Qingnian, Hongqi, Minzhu, Fuxing, Chunfeng, Hubin, Binjiang, Meihua, Taoyuan,
            Longjing, Zhonghua, Shengli, Dongmen, Ximen
            """
        ),
    ),
    "ar": StreetWords(
        ("Shari {}", "Zuqaq {}", "Darb {}", "Nahj {}"),
        _names(
            """
            al-Nasr, al-Salam, al-Jumhuriya, al-Hurriya, al-Istiqlal, al-Nakhil, al-Madina,
            al-Matar, al-Suq, al-Jamia, al-Zaytun, al-Yasmin, al-Ward, al-Nahr, al-Bahr, al-Qasr,
            al-Burj, al-Madrasa, al-Masjid, al-Rashid, al-Mutanabbi, Ibn Sina, Ibn Khaldun, Ibn
            Battuta, Salah al-Din, Umar al-Mukhtar, al-Farabi, al-Razi, al-Andalus, al-Quds,
            Dimashq, Baghdad, al-Qahira, Tunis, al-Rabi, al-Shams, al-Qamar, al-Wahda, al-Amal,
            al-Fajr
            """
        ),
    ),
}
"""By ISO 639-1 code."""
